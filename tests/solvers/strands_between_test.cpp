// Strands that go with guides: on a head that shakes, above shoulders.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "collision/check/penetration.h"
#include "tests/solvers/hair_scenes.h"

namespace ft {
namespace {

using namespace test;

constexpr int k_vertices = 24;

Placing shake(double times_a_second) {
  return [times_a_second](double t) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    if (t > 0) out.rotate(Eigen::AngleAxisd(0.6 * std::sin(2 * std::numbers::pi * times_a_second * t), Vec3::UnitY()));
    return out;
  };
}

/// Guides, and between each of them and the two that are nearest to it some strands.
HairSetup head_with_strands(int guides, int strands, int vertices, const Placing& way) {
  HairSetup setup = head_of_hair(guides, 0.2, vertices, way);
  std::vector<std::pair<double, int>> near;
  for (int s = 0; s < strands; ++s) {
    BetweenStrand& strand = setup.between.emplace_back();
    const int first = s % guides;
    const auto root = [&](int g) { return setup.strands[at(g)].positions[0]; };
    near.clear();
    for (int g = 0; g < guides; ++g)
      if (g != first) near.emplace_back((root(g) - root(first)).norm(), g);
    std::partial_sort(near.begin(), near.begin() + 2, near.end());
    const double a = 0.3 * random_uniform({1, 0, 0, at(s)}, 0), b = 0.3 * random_uniform({1, 0, 0, at(s)}, 1);
    strand.guides = {first, near[0].second, near[1].second};
    strand.share = {1 - a - b, a, b};
    strand.positions.assign(at(vertices), Vec3::Zero());
    for (std::size_t i = 0; i < at(vertices); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        strand.positions[i] += strand.share[k] * setup.strands[at(strand.guides[k])].positions[i];
    // Mixed on a ball they are under its skin: as far from it as guides are.
    for (Vec3& p : strand.positions) {
      const double keeps = k_head + std::min(0.003, 0.3 * (p - strand.positions[0]).norm());
      if (p.norm() < keeps) p *= keeps / p.norm();
    }
  }
  return setup;
}

struct Frame {
  std::vector<Vec3f> guides, strands;
};
Frame frame_of(const HairSolver& solver, const State& state) {
  FrameData data;
  solver.system_frame(state, 1, data);
  return {strands_of(solver, state), std::move(data.positions)};
}

TEST(StrandsBetween, Are_as_combed_to_begin_with) {
  const HairSetup setup = head_with_strands(60, 600, k_vertices, {});
  const auto solver = solver_of(setup);
  ASSERT_EQ(solver->system_count(), 2);
  EXPECT_EQ(solver->system_shape(1)->name, "hair_strands");
  EXPECT_EQ(solver->system_shape(1)->curves.curve_count(), 600);
  const Frame start = frame_of(*solver, solver->initial_state());
  double off = 0;
  for (std::size_t k = 0; k < start.strands.size(); ++k)
    off = std::max(off,
                   (start.strands[k].cast<double>() - setup.between[k / k_vertices].positions[k % k_vertices]).norm());
  EXPECT_LT(off, 3e-4);
}

TEST(StrandsBetween, Follow_their_roots_keep_their_length_stay_outside_and_do_not_pop) {
  const Placing way = shake(1.5);
  const HairSetup setup = head_with_strands(100, 2000, k_vertices, way);
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  Frame before = frame_of(*solver, state);
  std::vector<double> longer;
  int jumps = 0, inside = 0;
  double root_off = 0, all = 0;
  for (int f = 0; f < 36; ++f) {
    ASSERT_TRUE(solver->advance_frame(state).finite);
    const Frame now = frame_of(*solver, state);
    for (std::size_t k = 0; k < now.strands.size(); ++k) {
      const auto& own = setup.between[k / k_vertices];
      const std::size_t i = k % k_vertices, guide = at(own.guides[0]) * k_vertices + i;
      if (i == 0) {
        root_off = std::max(root_off, (now.strands[k].cast<double>() - way(state.time) * own.positions[0]).norm());
      } else {
        const double rest = (own.positions[i] - own.positions[i - 1]).norm();
        longer.push_back(std::abs((now.strands[k] - now.strands[k - 1]).norm() / rest - 1));
      }
      // Beside its guide from frame to frame.
      const double apart = (now.strands[k] - now.guides[guide]).norm();
      jumps += std::abs(apart - (before.strands[k] - before.guides[guide]).norm()) > 0.005 ? 1 : 0;
      ++all;
    }
    std::vector<Vec3> points(now.strands.size());
    for (std::size_t k = 0; k < points.size(); ++k) points[k] = now.strands[k].cast<double>();
    for (const HairBody& body : setup.bodies) {
      std::vector<Vec3> y(at(body.trajectory->surface().vertex_count()));
      body.trajectory->sample(state.time, y);
      for (const Penetration& p : penetrations(points, y, body.trajectory->surface().triangles, 1e-4))
        inside += p.vertex % k_vertices > 1 ? 1 : 0;
    }
    before = now;
  }
  std::sort(longer.begin(), longer.end());
  const double p99 = longer[longer.size() * 99 / 100];
  printf("roots %.2g m off, length p99 %.2g, %d of %.0f inside, %.3f %% jump\n", root_off, p99, inside, all,
         100 * jumps / all);
  EXPECT_LT(root_off, 1e-6);
  EXPECT_LT(p99, 0.02);
  EXPECT_EQ(inside, 0);
  EXPECT_LT(jumps / all, 0.001);
}

TEST(RiddenMesh, Is_as_combed_to_begin_with_goes_with_its_guide_and_its_cap_with_the_head) {
  const Placing way = shake(1);
  HairSetup setup = head_of_hair(20, 0.2, k_vertices, way);
  // A card along each strand, and a cap over the crown.
  for (int s = 0; s < 20; ++s)
    for (int i = 0; i < 12; ++i) {
      const double along = i / 11.0;
      const Vec3& p = setup.strands[at(s)].positions[at(2 * i)];
      for (const double side : {-0.004, 0.004}) {
        setup.ridden.positions.push_back(p + Vec3(side, 0, side));
        setup.riders.push_back({s, along});
      }
    }
  const std::size_t cap = setup.ridden.positions.size();
  for (int k = 0; k < 8; ++k) {
    setup.ridden.positions.emplace_back(0.03 * std::cos(k), 0.1, 0.03 * std::sin(k));
    setup.riders.push_back({-1, 0});
  }
  const auto solver = solver_of(setup);
  ASSERT_EQ(solver->system_count(), 2);
  ASSERT_EQ(solver->system_shape(1), nullptr);
  State state = solver->initial_state();
  std::vector<Vec3> now(setup.ridden.positions.size());
  solver->system_positions(state, 1, now);
  for (std::size_t v = 0; v < now.size(); ++v) EXPECT_LT((now[v] - setup.ridden.positions[v]).norm(), 1e-9) << v;
  double moved = 0;
  for (int f = 0; f < 12; ++f) {
    solver->advance_frame(state);
    solver->system_positions(state, 1, now);
    const std::vector<Vec3f> strands = strands_of(*solver, state);
    for (std::size_t v = 0; v < cap; ++v) {
      const std::size_t own = v / 24 * k_vertices + std::min<std::size_t>(v % 24 / 2 * 2, k_vertices - 1);
      EXPECT_LT((now[v] - strands[own].cast<double>()).norm(), 0.02) << f << " " << v;
      moved = std::max(moved, (now[v] - way(state.time) * setup.ridden.positions[v]).norm());
    }
    for (std::size_t v = cap; v < now.size(); ++v)
      EXPECT_LT((now[v] - way(state.time) * setup.ridden.positions[v]).norm(), 1e-9);
  }
  EXPECT_GT(moved, 0.03) << "cards swing";
}

TEST(StrandsBetween, Cost_of_20000_strands_of_32_slow) {
  const auto solver = solver_of(head_with_strands(500, 20000, 32, shake(1)));
  State state = solver->initial_state();
  std::vector<double> seconds;
  for (int f = 0; f < 12; ++f) {
    solver->advance_frame(state);
    const auto clock = std::chrono::steady_clock::now();
    frame_of(*solver, state);
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count());
  }
  std::sort(seconds.begin(), seconds.end());
  printf("%.1f ms a frame\n", 1e3 * seconds[6]);
  EXPECT_LT(seconds[6], 0.5);
}

}  // namespace
}  // namespace ft
