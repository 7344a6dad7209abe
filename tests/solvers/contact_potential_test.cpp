// Pairs that come while a solve is under way count as if they had been there from its start.
#include "solvers/cloth/model/contact_potential.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "baker/core/random.h"
#include "tests/support/numbered_pairs.h"

namespace ft {
namespace {

constexpr int k_cloth = 20, k_all = 26;  ///< vertices

Vec3 somewhere(std::uint64_t draw, std::uint64_t i, double size) {
  const auto u = [&](std::uint64_t k) { return size * random_uniform({11, 0, draw, i}, k); };
  return {u(0), u(1), u(2)};
}

struct Heap {
  ContactModel model;
  ContactPairs pairs;  ///< all vertices with faces, and edges, of consecutive vertices; none of the body with itself
  std::vector<Vec3> rest, start, way, moved, displacement;  ///< way: of the cloth, from start to moved

  Heap() {
    model.cloth_vertex_count = k_cloth;
    model.area.assign(k_cloth, 1e-4);
    model.radius.assign(k_cloth, 3e-3);
    model.friction = model.self_friction = {0.3};
    model.garment.assign(k_cloth, 0);
    for (std::uint64_t i = 0; i < k_all; ++i) {
      if (i < k_cloth) rest.push_back(somewhere(0, i, 1));
      start.push_back(somewhere(1, i, 0.01));
      moved.push_back(start.back());
      if (i >= k_cloth) continue;
      way.push_back(somewhere(2, i, 5e-4));
      moved.back() += way.back();
      displacement.push_back(somewhere(3, i, 5e-4));
    }
    model.rest = rest;
    for (int v = 0; v < k_all; ++v)
      for (int f = 0; f + 2 < k_all; ++f)
        if ((v < f || v > f + 2) && (v < k_cloth || f + 2 < k_cloth))
          pairs.vertex_face.push_back({{v, f, f + 1, f + 2}});
    for (int a = 0; a + 1 < k_all; ++a)
      for (int b = a + 2; b + 1 < k_all; ++b)
        if (a + 1 < k_cloth) pairs.edge_edge.push_back({{a, a + 1, b, b + 1}});
  }
};

struct Outcome {
  double value;
  std::vector<Vec3> gradient;
  std::vector<Stencil> near;
};

/// The last pairs come when all are at `moved`.
Outcome walk(const Heap& heap, double come_late) {
  const test::NumberedPairs numbered(heap.pairs);
  PairList pairs = numbered.list, late;
  const auto hold_back = [&](std::vector<PairKey>& list, std::vector<PairKey>& rest) {
    const auto from = list.end() - static_cast<std::ptrdiff_t>(come_late * static_cast<double>(list.size()));
    rest.assign(from, list.end());
    list.erase(from, list.end());
  };
  hold_back(pairs.vertex_face, late.vertex_face);
  hold_back(pairs.edge_edge, late.edge_edge);
  ContactPotential contact(heap.model);
  contact.begin(pairs, heap.start, 0.01);
  contact.update(heap.start);
  contact.lag_friction();
  contact.update(heap.moved, heap.way);
  contact.lag_friction();
  pairs.vertex_face.insert(pairs.vertex_face.end(), late.vertex_face.begin(), late.vertex_face.end());
  pairs.edge_edge.insert(pairs.edge_edge.end(), late.edge_edge.begin(), late.edge_edge.end());
  contact.extend(heap.moved);
  EXPECT_GT(contact.contacts().size(), 10u);

  PairPlaces near;
  std::vector<double> lengths;
  for (const Vec3& d : heap.displacement) lengths.push_back(d.norm());
  contact.near_pairs(lengths, 1e-5, near);
  Outcome out;
  const PairView view(near);
  for (const PairKind kind : {PairKind::k_vertex_face, PairKind::k_edge_edge})
    for (std::size_t i = 0; i < view.count(kind); ++i) out.near.push_back(view.stencil(kind, i));
  std::sort(out.near.begin(), out.near.end());
  std::vector<Vec3> next = heap.moved;
  for (std::size_t i = 0; i < k_cloth; ++i) next[i] += heap.displacement[i];
  contact.update(next, heap.displacement);
  out.value = contact.value(next);
  out.gradient.assign(k_cloth, Vec3::Zero());
  contact.add_gradient(next, out.gradient);
  return out;
}

TEST(ContactPotential, takes_up_pairs_that_come_late_as_if_they_had_been_there) {
  const Heap heap;
  const Outcome all = walk(heap, 0), some = walk(heap, 0.4), none = walk(heap, 1);
  EXPECT_GT(all.value, 0);
  for (const Outcome* late : {&some, &none}) {
    EXPECT_NEAR(late->value, all.value, 1e-12 * all.value);
    for (std::size_t i = 0; i < k_cloth; ++i)
      EXPECT_LT((late->gradient[i] - all.gradient[i]).norm(), 1e-12 * (1 + all.gradient[i].norm()));
    EXPECT_EQ(late->near, all.near);
  }
}

/// What the terms make of the matrix [N/m].
Eigen::MatrixXd matrix_of(const ContactPotential& contact, std::span<const Vec3> x, std::size_t* count = nullptr) {
  std::vector<PairTerm> terms;
  contact.add_terms(x, terms);
  if (count != nullptr) *count = terms.size();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3 * k_cloth, 3 * k_cloth);
  for (const PairTerm& t : terms)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        if (t.vertex[a] >= 0 && t.vertex[b] >= 0)
          out.block<3, 3>(3 * t.vertex[a], 3 * t.vertex[b]) += (t.weight[a] * t.weight[b] * t.stiffness).cast<double>();
  return out;
}

TEST(ContactPotential, Has_one_term_for_a_contact_and_the_friction_lagged_there_and_none_is_lost_elsewhere) {
  const Heap heap;
  std::vector<Vec3> next = heap.moved;
  for (std::size_t i = 0; i < k_cloth; ++i) next[i] += heap.displacement[i];
  const test::NumberedPairs numbered(heap.pairs);
  ContactPotential rough(heap.model), smooth(heap.model);
  for (ContactPotential* contact : {&rough, &smooth}) {
    contact->begin(numbered.list, heap.start, 0.01);
    contact->update(heap.moved);
  }
  rough.lag_friction();
  std::size_t count = 0;
  const Eigen::MatrixXd there = matrix_of(rough, next, &count) - matrix_of(smooth, next);
  EXPECT_EQ(count, rough.contacts().size());
  for (ContactPotential* contact : {&rough, &smooth}) contact->update(next);
  const Eigen::MatrixXd normal = matrix_of(smooth, next), elsewhere = matrix_of(rough, next, &count) - normal;
  EXPECT_GT(count, rough.contacts().size());
  EXPECT_GT(there.norm(), 0);
  // Terms are single precision: of the whole matrix that is left of them.
  EXPECT_LT((there - elsewhere).norm(), 1e-5 * (there.norm() + normal.norm()));
}

TEST(ContactLaw, Force_and_stiffness_are_its_slopes_and_do_not_jump) {
  constexpr double r = 2e-3, k = 5e5;
  for (double d = 1e-6; d < 1.2 * r; d *= 1.07) {
    const double step = 1e-4 * d;
    const ContactLaw before = contact_law(d - step, r, k), here = contact_law(d, r, k),
                     after = contact_law(d + step, r, k);
    EXPECT_NEAR((before.energy - after.energy) / (2 * step), here.force, 1e-6 * here.force + 1e-6 * k * r) << d;
    EXPECT_NEAR((before.force - after.force) / (2 * step), here.stiffness, 1e-3 * here.stiffness + 1e-3 * k) << d;
    EXPECT_GE(before.force, after.force);
  }
  for (const double join : {r / 2, r / 8}) {
    const ContactLaw inside = contact_law(join * (1 - 1e-9), r, k), outside = contact_law(join * (1 + 1e-9), r, k);
    EXPECT_NEAR(inside.energy, outside.energy, 1e-6 * outside.energy);
    EXPECT_NEAR(inside.force, outside.force, 1e-6 * outside.force);
    EXPECT_NEAR(inside.stiffness, outside.stiffness, 1e-6 * outside.stiffness);
  }
}

TEST(ContactLaw, Holds_a_hundred_kilopascal_off_by_more_than_a_fiftieth_of_the_radius) {
  EXPECT_GT(contact_law(2e-3 / 50, 2e-3, 5e5).force, 1e5);
  EXPECT_GT(contact_law(3e-3 / 50, 3e-3, 5e5).force, 1e5);
}

}  // namespace
}  // namespace ft
