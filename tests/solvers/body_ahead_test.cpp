// The body between the frame's ends: feasible at every other substep, and near enough to that in between.
#include "solvers/cloth/body_ahead.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr double k_large = 0.15, k_small = 0.05;  ///< radii [m]
constexpr double k_depth = 0.03;                  ///< by so much the small sphere is drawn inside the large one [m]
constexpr double k_turn = 20 * std::numbers::pi / 180;
constexpr double k_gap = 6e-3;

/// A small sphere that turns about the centre of a large one, half in it, by k_turn in a second.
struct Spheres {
  std::size_t small_begin = 0;  ///< drawn vertices
  std::unique_ptr<MovingCollider> collider;

  Spheres() {
    std::vector<Vec3> points;
    Surface surface;
    make_sphere(k_large, 24, 48, points, surface.triangles);
    small_begin = points.size();
    make_sphere(k_small, 12, 24, points, surface.triangles);
    surface.part_of_vertex.assign(points.size(), 0);
    std::fill(surface.part_of_vertex.begin() + static_cast<std::ptrdiff_t>(small_begin), surface.part_of_vertex.end(),
              1);
    surface.parts = {{"large", -1, 2.0}, {"small", -1, 1.0}};
    std::vector<Vec3> bind = points;
    for (std::size_t i = small_begin; i < bind.size(); ++i) bind[i].x() += 0.4;
    const auto motion = [points, first = small_begin](double time, std::span<Vec3> x) {
      const Eigen::AngleAxisd turn(k_turn * time, Vec3::UnitZ());
      for (std::size_t i = first; i < x.size(); ++i)
        x[i] = turn * (points[i] + Vec3(k_large + k_small - k_depth, 0, 0));
    };
    FeasibleSettings settings;
    settings.gap = k_gap;
    collider = std::make_unique<MovingCollider>(std::make_shared<ScriptedBody>(surface, bind, 0.0, motion), settings);
  }
  std::vector<Vec3> feasible(double time) const {
    std::vector<Vec3> drawn, out;
    collider->drawn(time, drawn);
    collider->feasible(time, drawn, out);
    return out;
  }
};

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double out = 0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, (a[i] - b[i]).norm());
  return out;
}

class BodyBetween : public testing::TestWithParam<int> {};

TEST_P(BodyBetween, is_feasible_at_every_other_substep_and_keeps_most_of_the_gap_at_the_others) {
  const Spheres s;
  const int substeps = GetParam();
  BodyAhead body(s.collider.get());
  body.begin(0, 1, substeps);
  EXPECT_EQ(body.start().feasible, s.feasible(0));
  EXPECT_EQ(body.end().feasible, s.feasible(1));
  ASSERT_GT(farthest(body.start().given_way, std::vector<Vec3>(body.start().given_way.size(), Vec3(0, 0, 0))), k_depth);
  for (int k = 0; k < substeps; ++k) {
    const BodyPose& pose = body.after(k, substeps);
    const std::vector<Vec3> worked_out = s.feasible(static_cast<double>(k + 1) * (1.0 / substeps));
    if (substeps < 4 || k % 2 == 1 || k + 1 == substeps)
      EXPECT_EQ(pose.feasible, worked_out) << k;
    else
      EXPECT_LT(farthest(pose.feasible, worked_out), 0.5 * k_gap) << k;
    double nearest = 1;
    for (std::size_t v = 0; v < pose.feasible.size(); ++v)
      if (s.collider->part_of_vertex()[v] == 1) nearest = std::min(nearest, pose.feasible[v].norm() - k_large);
    EXPECT_GT(nearest, 0.8 * k_gap) << k;
  }
}
INSTANTIATE_TEST_SUITE_P(Substeps, BodyBetween, testing::Values(1, 2, 3, 4, 5, 8, 9, 10, 17, 20));

TEST(BodyAhead, does_not_depend_on_what_was_worked_out_before) {
  const Spheres s;
  BodyAhead expected(s.collider.get()), surprised(s.collider.get());
  expected.begin(0, 1, 20);
  surprised.begin(0, 1, 4);
  for (int k = 0; k < 3; ++k) surprised.after(k, 4);  // an attempt that is given up
  for (int k = 0; k < 20; ++k) EXPECT_EQ(surprised.after(k, 20).feasible, expected.after(k, 20).feasible) << k;
  surprised.begin(1, 2, 6);
  expected.begin(7, 8, 5);
  expected.begin(1, 2, 5);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(surprised.after(k, 6).feasible, expected.after(k, 6).feasible) << k;
}

}  // namespace
}  // namespace ft
