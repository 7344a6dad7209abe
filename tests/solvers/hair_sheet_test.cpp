// Hair and sheets, which have no inside: what was on one side of one stays there.
#include "collision/check/crossings.h"
#include "solvers/hair/sheet_passage.h"
#include "tests/solvers/hair_scenes.h"

namespace ft {
namespace {

using namespace test;

/// A crumpled sheet in x and z with teeth along its rim at +x, at a height.
TriangleSurface toothed_sheet(double height, double tooth, int teeth) {
  TriangleSurface out;
  const auto y = [&](int k) { return height + 0.01 * random_uniform({1, 0, 0, static_cast<std::uint64_t>(k)}, 0); };
  for (int k = 0; k <= 2 * teeth; ++k) {
    const double z = tooth * (0.5 * k - 0.5 * teeth);
    out.positions.emplace_back(-0.05, y(2 * k), z);
    out.positions.emplace_back(k % 2 == 1 ? 0.03 : 0.0, y(2 * k + 1), z);
  }
  for (int k = 0; k < 2 * teeth; ++k) {
    out.triangles.push_back({2 * k, 2 * k + 2, 2 * k + 1});
    out.triangles.push_back({2 * k + 1, 2 * k + 2, 2 * k + 3});
  }
  return out;
}

int crossings(std::span<const Vec3f> x, int vertices, std::span<const Vec3> y, std::span<const Triangle> triangles) {
  int out = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (i % at(vertices) == 0) continue;
    const Vec3 a = x[i - 1].cast<double>(), b = x[i].cast<double>();
    out += std::ranges::any_of(triangles, [&](const Triangle& t) {
      return edge_crosses_triangle(a, b, y[at(t[0])], y[at(t[1])], y[at(t[2])]);
    });
  }
  return out;
}

TEST(HairSheet, A_passage_is_found_where_an_edge_meets_the_segment_and_on_the_segments_side) {
  TriangleSurface sheet;
  sheet.positions = {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(-1, 0, 0)};
  sheet.triangles = {{0, 1, 2}};
  const std::vector<HairBody> given{{"sheet", rigid_body(sheet, Vec3::Zero()), 1, true}};
  HairBodies bodies(given);
  bodies.start_at(0);
  bodies.end_at(0.01);
  // From beside the rim at x = 0 to through the triangle: over the rim.
  const Vec3 low(0.01, -0.03, 0), high(0.01, 0.01, 0), goes(-0.02, 0, 0);
  const auto found = find_sheet_passage(bodies, {low, high, low + goes, high + goes});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->share, 0.75, 1e-3);
  EXPECT_GT(found->surface.normal.x(), 0.999);
  EXPECT_NEAR(found->surface.weights[0], 0.5, 1e-3);
  EXPECT_NEAR(found->surface.weights[1], 0.5, 1e-3);
  // An end through the face, from above.
  const Vec3 start(-0.2, 0.005, 0), end(-0.2, 0.05, 0), down(0, -0.02, 0);
  const auto through = find_sheet_passage(bodies, {start, end, start + down, end});
  ASSERT_TRUE(through);
  EXPECT_EQ(through->share, 0);
  EXPECT_GT(through->surface.normal.y(), 0.999);
  // Beside it, and through it already at the start.
  EXPECT_FALSE(find_sheet_passage(bodies, {low, high, low, high}));
  EXPECT_FALSE(find_sheet_passage(bodies, {low + goes, high + goes, low + 2 * goes, high + 2 * goes}));
}

TEST(HairSheet, A_toothed_rim_that_sweeps_through_hanging_hair_takes_it_along) {
  constexpr int k_vertices = 12;
  HairSetup setup = head_of_hair(60, 0.3, k_vertices);
  setup.bodies.pop_back();
  setup.material.stiffness = 1;
  const TriangleSurface sheet = toothed_sheet(-0.11, 0.012, 24);
  const Vec3 place(-0.16, 0, 0);
  const auto sweep = [](double t) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.translation().x() = 0.07 * (1 - std::cos(2 * std::numbers::pi * std::max(0.0, t)));
    return out;
  };
  setup.bodies.push_back({"sheet", rigid_body(sheet, place, sweep), 1, true});
  for (std::size_t s = 0; s < setup.strands.size(); ++s)
    for (int copy = 0; copy < 4; ++copy) {
      BetweenStrand strand;
      strand.guides = {static_cast<int>(s), -1, -1};
      strand.share = {1, 0, 0};
      const double angle = 1.5 * copy;
      for (std::size_t i = 0; i < k_vertices; ++i)
        strand.positions.push_back(setup.strands[s].positions[i] + 0.004 * std::min(1.0, 0.2 * static_cast<double>(i)) *
                                                                       Vec3(std::cos(angle), 0, std::sin(angle)));
      setup.between.push_back(std::move(strand));
    }
  const auto trajectory = setup.bodies.back().trajectory;
  const auto solver = solver_of(std::move(setup));
  EXPECT_EQ(solver->combed_through(), 0);
  State state = solver->initial_state();
  std::vector<Vec3> y(sheet.positions.size());
  double farthest = 0;  // that hair under the sheet is pushed, of the hair on its side of the head
  for (int frame = 0; frame < 24; ++frame) {
    const FrameReport report = solver->advance_frame(state);
    EXPECT_TRUE(report.incidents.empty()) << report.incidents[0].text;
    trajectory->sample(state.time, y);
    EXPECT_EQ(crossings(strands_of(*solver, state), k_vertices, y, sheet.triangles), 0) << state.frame;
    FrameData between;
    solver->system_frame(state, 1, between);
    EXPECT_EQ(crossings(between.positions, k_vertices, y, sheet.triangles), 0) << state.frame;
    double least = 0;
    for (const Vec3f& p : between.positions)
      if (p.y() < -0.14) least = std::min(least, static_cast<double>(p.x()));
    farthest = std::max(farthest, least + k_head);
  }
  EXPECT_GT(farthest, 0.03);
}

}  // namespace
}  // namespace ft
