// Cloth that crosses cloth where the shot starts: the walk keeps its pace, says so, and cloth holds cloth again once it
// is out.
#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/random.h"
#include "collision/check/crossings.h"
#include "solvers/cloth/cloth_solver.h"
#include "solvers/cloth/solve/untangle.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

ClothGarment strip(const char* name, const Vec3& middle, double size, int cells, bool upright) {
  ClothGarment out;
  out.name = name;
  out.mesh = make_sheet(size, cells, 0);
  for (Vec3& p : out.mesh.positions) p = middle + (upright ? Vec3(p.x(), p.z(), 0) : p);
  return out;
}

/// A sheet held by its rim, and a smaller one upright with its upper edge `above` it.
ClothSetup sheet_through_sheet(double above) {
  ClothSetup setup;
  setup.preroll_frames = 0;
  ClothGarment floor = strip("floor", Vec3::Zero(), 0.6, 20, false);
  ClothPin rim;
  for (int i = 0; i < 21 * 21; ++i)
    if (i % 21 == 0 || i % 21 == 20 || i / 21 == 0 || i / 21 == 20) rim.vertices.push_back(i);
  floor.pins.push_back(rim);
  setup.garments.push_back(std::move(floor));
  setup.garments.push_back(strip("strip", Vec3(3e-3, above - 0.1, 4e-3), 0.2, 10, true));
  return setup;
}

TEST(Tangles, do_not_slow_the_walk_down_and_are_named) {
  auto solver = make_cloth_solver(sheet_through_sheet(0.1));
  ASSERT_TRUE(solver);
  State state = (*solver)->initial_state();
  int untangled = 0;
  for (int f = 0; f < 4; ++f) {
    const FrameReport r = (*solver)->advance_frame(state);
    EXPECT_TRUE(r.finite);
    EXPECT_LE(r.substeps, 8) << r.frame;
    EXPECT_EQ(r.rewinds, 0) << r.frame;
    EXPECT_LT(r.strain_p99, 0.05) << r.frame;
    if (r.crossings_self == 0) ++untangled;
    EXPECT_EQ(r.incidents.empty(), r.crossings_self == 0) << r.frame;
  }
  EXPECT_LT(untangled, 4);
}

TEST(Tangles, end_when_the_cloth_has_come_out) {
  auto solver = make_cloth_solver(sheet_through_sheet(0.02));
  ASSERT_TRUE(solver);
  State state = (*solver)->initial_state();
  FrameReport last;
  for (int f = 0; f < 14; ++f) last = (*solver)->advance_frame(state);
  EXPECT_EQ(last.crossings_self, 0);
  const std::vector<double>* tangled = state.find("tangled");
  ASSERT_TRUE(tangled);
  for (const double t : *tangled) ASSERT_EQ(t, 0);
}

/// Length of the line in which two crossing triangles cut each other.
double contour(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  std::vector<Vec3> ends;
  for (const Crossing& c : crossings_within(x, triangles)) {
    const Vec3 &p = x[at(c.edge[0])], &q = x[at(c.edge[1])], &a = x[at(c.triangle[0])];
    const Vec3 n = (x[at(c.triangle[1])] - a).cross(x[at(c.triangle[2])] - a);
    ends.push_back(p + (a - p).dot(n) / (q - p).dot(n) * (q - p));
  }
  double longest = 0;
  for (const Vec3& a : ends)
    for (const Vec3& b : ends) longest = std::max(longest, (a - b).norm());
  return longest;
}

TEST(Tangles, are_pushed_so_that_the_contour_gets_shorter) {
  int tried = 0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    std::vector<Vec3> x(6);
    for (std::uint64_t i = 0; i < 18; ++i) x[i / 3][static_cast<int>(i % 3)] = 2 * random_uniform({7, 0, 0, k}, i) - 1;
    const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
    const auto crossings = crossings_within(x, triangles);
    if (crossings.empty()) continue;
    std::vector<Vec3> push(6);
    untangling(x, triangles, crossings, push);
    const double before = contour(x, triangles);
    for (std::size_t i = 0; i < 6; ++i) x[i] += 1e-6 * push[i];
    if (before < 0.1 || crossings_within(x, triangles).size() != crossings.size()) continue;
    ++tried;
    EXPECT_LT(contour(x, triangles), before) << k;
  }
  EXPECT_GT(tried, 50);
}

TEST(Tangles, come_undone_where_nothing_holds_them) {
  ClothSetup setup = sheet_through_sheet(0.19);  // gravity alone pulls it deeper: out is up
  setup.gravity.setZero();
  auto solver = make_cloth_solver(setup);
  ASSERT_TRUE(solver);
  State state = (*solver)->initial_state();
  FrameReport last;
  for (int f = 0; f < 24; ++f) last = (*solver)->advance_frame(state);
  EXPECT_EQ(last.crossings_self, 0);
  EXPECT_LT(last.strain_p99, 0.05);
}

/// Two sheets of 0.2 m on each other, 2 mm apart; the vertices of the upper one within `reach` of the middle of the
/// lower one are `depth` below it [m].
ClothSetup layers_with_a_dent(double reach, double depth) {
  ClothSetup setup;
  setup.preroll_frames = 0;
  setup.gravity.setZero();
  setup.garments.push_back(strip("lower", Vec3::Zero(), 0.2, 20, false));
  setup.garments.push_back(strip("upper", Vec3(3e-3, 2e-3, 4e-3), 0.2, 20, false));
  for (Vec3& p : setup.garments[1].mesh.positions)
    if (Vec3(p.x() - 3e-3, 0, p.z() - 4e-3).norm() < reach) p.y() = -depth;
  return setup;
}

/// Crossings at the start and after each of the frames.
std::vector<int> crossings_over(const ClothSetup& setup, int frames) {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  for (const ClothGarment& garment : setup.garments) {
    const int first = static_cast<int>(x.size());
    x.insert(x.end(), garment.mesh.positions.begin(), garment.mesh.positions.end());
    for (const Triangle& t : triangulate(garment.mesh)) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  std::vector<int> out{static_cast<int>(crossings_within(x, triangles).size())};
  auto solver = make_cloth_solver(setup);
  if (!solver) return {};
  State state = (*solver)->initial_state();
  for (int f = 0; f < frames; ++f) {
    const FrameReport report = (*solver)->advance_frame(state);
    EXPECT_LT(report.strain_p99, 0.1) << f;
    EXPECT_EQ(report.rewinds, 0) << f;
    out.push_back(report.crossings_self);
  }
  return out;
}

void expect_undone(const ClothSetup& setup, int frames) {
  const std::vector<int> crossings = crossings_over(setup, frames);
  ASSERT_FALSE(crossings.empty());
  EXPECT_GT(crossings.front(), 0);
  for (std::size_t f = 1; f < crossings.size(); ++f) EXPECT_LE(crossings[f], crossings[f - 1]) << f;
  EXPECT_EQ(crossings.back(), 0);
}

TEST(Tangles, one_vertex_through_a_layer_is_taken_back) {
  expect_undone(layers_with_a_dent(5e-3, 2e-3), 6);
}

TEST(Tangles, a_patch_inside_a_closed_contour_is_taken_back_row_by_row) {
  expect_undone(layers_with_a_dent(17e-3, 3e-3), 10);
}

TEST(Tangles, a_corner_through_a_sheet_is_drawn_out) {
  ClothSetup setup;
  setup.preroll_frames = 0;
  setup.gravity.setZero();
  setup.garments.push_back(strip("sheet", Vec3::Zero(), 0.2, 20, false));
  setup.garments.push_back(strip("corner", Vec3::Zero(), 0.1, 10, true));
  const double half = std::sqrt(0.5);
  for (Vec3& p : setup.garments[1].mesh.positions)  // stands on its corner, which is 17 mm below the sheet
    p = Vec3(half * (p.x() - p.y()) + 3e-3, half * (p.x() + p.y()) + 0.1 * half - 17e-3, 4e-3);
  expect_undone(setup, 24);
}

TEST(Tangles, are_taken_apart_before_the_preroll_and_that_ends) {
  ClothSetup setup = layers_with_a_dent(5e-3, 2e-3);
  setup.preroll_frames = 3;
  auto solver = make_cloth_solver(setup);
  ASSERT_TRUE(solver);
  State state = (*solver)->initial_state();
  const int frame = state.frame;
  EXPECT_EQ((*solver)->settling(state).frames, 0);
  while ((*solver)->settling(state).goes_on) {
    (*solver)->settle_frame(state);
    ASSERT_LE((*solver)->settling(state).frames, 48);
  }
  EXPECT_GT((*solver)->settling(state).frames, 0);
  EXPECT_EQ((*solver)->settling(state).crossings, 0);
  EXPECT_EQ(state.frame, frame);
  const FrameReport report = (*solver)->advance_frame(state);
  EXPECT_EQ(report.frame, frame + 1);
  EXPECT_EQ(report.crossings_self, 0);
}

TEST(Tangles, what_starts_apart_does_not_settle) {
  ClothSetup setup = layers_with_a_dent(0, 0);
  setup.preroll_frames = 3;
  auto solver = make_cloth_solver(setup);
  ASSERT_TRUE(solver);
  const State state = (*solver)->initial_state();
  EXPECT_FALSE((*solver)->settling(state).goes_on);
}

TEST(Tangles, layers_nearer_than_contact_reaches_stay_apart) {
  ClothSetup setup = layers_with_a_dent(0, 0);
  for (Vec3& p : setup.garments[1].mesh.positions) p.y() = 2e-4;
  setup.gravity = Vec3(0, -k_gravity, 0);
  const std::vector<int> crossings = crossings_over(setup, 4);
  ASSERT_FALSE(crossings.empty());
  for (const int c : crossings) EXPECT_EQ(c, 0);
}

}  // namespace
}  // namespace ft
