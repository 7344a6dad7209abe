// Derivatives of what cords and contact are made of, against differences.
#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/random.h"
#include "solvers/lockstep/lockstep_contact.h"
#include "tests/support/ball_and_net.h"

namespace ft {
namespace {

using namespace test;

std::vector<Vec3> gradient_of(const std::vector<NodeTerm>& terms, std::size_t nodes) {
  std::vector<Vec3> out(nodes, Vec3::Zero());
  for (const NodeTerm& t : terms)
    for (int k = 0; k < t.count; ++k) out[at(t.node[at(k)])] += t.weight[at(k)] * t.force;
  return out;
}

template <class Value, class Terms>
void expect_gradient(std::vector<Vec3> x, const Value& value, const Terms& terms, double tolerance) {
  std::vector<NodeTerm> all;
  terms(x, all);
  const std::vector<Vec3> gradient = gradient_of(all, x.size());
  double largest = 0;
  for (const Vec3& g : gradient) largest = std::max(largest, g.norm());
  ASSERT_GT(largest, 0);
  const double step = 1e-7;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double kept = x[i][k];
      x[i][k] = kept + step;
      const double above = value(x);
      x[i][k] = kept - step;
      const double below = value(x);
      x[i][k] = kept;
      EXPECT_NEAR((above - below) / (2 * step), gradient[i][k], tolerance * largest) << "node " << i << " axis " << k;
    }
}

TEST(LockstepTerms, Gradient_of_cords_is_the_slope_of_their_energy) {
  CordElements e;
  e.springs = {{0, 1, 0.1, 300, 0.4, false}, {1, 2, 0.1, 300, 0.4, true}};
  e.bends = {{{0, 1, 2}, 40, 0.2}};
  e.holds = {{0, Vec3(0.01, 0, 0), 50}};
  e.drags = {{1, 2, 0.003}};
  e.air = {1.2, steady_wind(Vec3(1, 0, 0))};
  const std::vector<Vec3> start{{0, 0, 0}, {0.11, 0, 0.01}, {0.2, 0.02, 0}}, v{{1, 2, 0}, {0, 1, 0}, {-1, 0, 3}};
  e.begin_step(0, 1e-3, start, v);
  std::vector<Vec3> x = start;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 1e-3 * v[i];
  expect_gradient(
      x, [&](const auto& p) { return e.value(p); }, [&](const auto& p, auto& out) { e.add_terms(p, out); }, 1e-6);
}

TEST(LockstepTerms, A_taut_cord_pulls_a_slack_one_does_nothing_and_none_pushes) {
  CordElements e;
  e.springs = {{0, 1, 0.1, 300, 4, false}};
  std::vector<NodeTerm> out;
  const std::vector<Vec3> still(2, Vec3::Zero()), taut{{0, 0, 0}, {0.11, 0, 0}}, slack{{0, 0, 0}, {0.09, 0, 0}};
  e.begin_step(0, 1e-3, taut, still);
  e.add_terms(taut, out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_NEAR(-out[0].force.x(), 3, 1e-12);  // no damping where it does not change
  out.clear();
  e.add_terms(std::vector<Vec3>{{0, 0, 0}, {0.1001, 0, 0}}, out);  // shortens fast: damping would have it push
  EXPECT_TRUE(out.empty());
  e.begin_step(0, 1e-3, slack, still);
  e.add_terms(slack, out);
  EXPECT_TRUE(out.empty());
}

TEST(LockstepTerms, Gradient_of_contact_and_friction_is_the_slope_of_their_energy_and_adds_up_to_nothing) {
  LockstepSetup setup;
  CordSystem cord;
  cord.name = "cord";
  cord.graph.points = {{-0.06, 0.1222, 0.01}, {0.003, 0.1226, 0.002}, {0.05, 0.1224, 0.0}};
  cord.graph.cords = {{0, 1}, {1, 2}};
  cord.graph.strands = {{0, 1, 2}};
  setup.cords = {cord};
  setup.prop = flying_ball(Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), true);
  const auto model = build_lockstep_model(setup);
  ASSERT_TRUE(model);
  LockstepContact contact(*model);
  std::vector<Vec3> x = model->start;
  for (const Vec3& p : model->frame.place({})) x.push_back(p);
  std::vector<Vec3> before = x;
  for (std::size_t i = 0; i < 3; ++i) before[i] += Vec3(2e-4, 0, 1e-4 * static_cast<double>(i));  // it slid since
  contact.find(x, std::vector<Vec3>(x.size(), Vec3::Zero()));
  contact.lag_friction(x, before, 1.0 / 600);
  ASSERT_TRUE(contact.has_friction());
  expect_gradient(
      x, [&](const auto& p) { return contact.value(p); }, [&](const auto& p, auto& out) { contact.add_terms(p, out); },
      1e-4);
  std::vector<NodeTerm> terms;
  contact.add_terms(x, terms);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& g : gradient_of(terms, x.size())) sum += g;
  EXPECT_LT(sum.norm(), 1e-12);
  Vec3 on_cord = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) on_cord -= gradient_of(terms, x.size())[i];
  EXPECT_LT((contact.on_met(x)[0].force + on_cord).norm(), 1e-12);
}

TEST(LockstepTerms, The_direct_solver_solves_what_terms_add_up_to) {
  NodeSystem system;
  std::uint64_t draw = 0;
  const auto number = [&] { return 2 * random_uniform({7, 0, 0, 0}, draw++) - 1; };
  const auto point = [&] {
    const double x = number(), y = number(), z = number();
    return Vec3(x, y, z);
  };
  const std::size_t n = 12;
  std::vector<Vec3> wanted(n), rhs(n), found(n);
  for (int round = 0; round < 3; ++round) {  // the pattern changes from round to round
    const std::vector<double> diagonal(n, 2.0);
    std::vector<NodeTerm> terms;
    for (int t = 0; t < 20 + round; ++t) {
      NodeTerm& term = terms.emplace_back();
      const int first = (5 * t + round) % static_cast<int>(n - 3);
      for (int k = 0; k < 4; ++k) term.add(first + k, number());
      const Vec3 along = point();
      term.stiffness = along * along.transpose();
    }
    for (Vec3& w : wanted) w = point();
    system.begin(diagonal);
    for (std::size_t i = 0; i < n; ++i) rhs[i] = 2 * wanted[i];
    for (const NodeTerm& t : terms) {
      system.add(t);
      Vec3 u = Vec3::Zero();
      for (int k = 0; k < t.count; ++k) u += t.weight[at(k)] * wanted[at(t.node[at(k)])];
      for (int k = 0; k < t.count; ++k) rhs[at(t.node[at(k)])] += t.weight[at(k)] * t.stiffness * u;
    }
    ASSERT_TRUE(system.solve(rhs, found));
    for (std::size_t i = 0; i < n; ++i) EXPECT_LT((found[i] - wanted[i]).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace ft
