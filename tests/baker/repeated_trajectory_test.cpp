// Clips that are played several times in a row.
#include "baker/plan/repeated_trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scripted_body.h"

namespace ft {
namespace {

/// Three points that go 2 m along x in a period of 0.5 s, bob meanwhile, and turn by 30 degrees about y.
std::shared_ptr<const Trajectory> hop(double lands = 0) {
  Surface surface;
  surface.triangles = {{0, 1, 2}};
  return std::make_shared<ScriptedBody>(
      surface, std::vector<Vec3>{{0, 0, 0}, {0.3, 0, 0}, {0, 0.5, 0.2}}, 0, [lands](double time, std::span<Vec3> x) {
        const double share = time / 0.5;
        const Eigen::AngleAxisd turned(share * std::numbers::pi / 6, Vec3::UnitY());
        for (Vec3& p : x)
          p = turned * p + Vec3(2 * share, std::abs(std::sin(share * std::numbers::pi)) + lands * share, 0);
      });
}

std::vector<Vec3> pose(const Trajectory& body, double time) {
  std::vector<Vec3> out(3);
  body.sample(time, out);
  return out;
}

TEST(RepeatedTrajectory, Each_time_it_goes_on_from_where_the_last_one_has_got_to) {
  const RepeatedTrajectory body(hop(), 0.5, 4);
  EXPECT_LT(body.misfit(), 1e-12);
  for (const double seam : {0.5, 1.0, 1.5}) {
    const auto before = pose(body, seam - 1e-9), after = pose(body, seam + 1e-9);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LT((after[i] - before[i]).norm(), 1e-6) << seam;
  }
  // Four hops of 2 m, each turned by 30 degrees against the last.
  Vec3 end = Vec3::Zero();
  for (int k = 0; k < 4; ++k)
    end += 2 * Vec3(std::cos(k * std::numbers::pi / 6), 0, -std::sin(k * std::numbers::pi / 6));
  EXPECT_LT((pose(body, 2)[0] - end).norm(), 1e-9);
}

TEST(RepeatedTrajectory, It_stays_on_the_level_and_says_where_the_clip_does_not_close) {
  const RepeatedTrajectory body(hop(0.1), 0.5, 3);
  EXPECT_NEAR(body.misfit(), 0.1, 1e-9);
  EXPECT_NEAR(pose(body, 1.0 + 1e-12)[0].y(), 0, 1e-6);
}

}  // namespace
}  // namespace ft
