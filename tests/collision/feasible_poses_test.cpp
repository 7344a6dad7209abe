// What a search of the clip has kept is what an evaluation gives, and stays in bounds.
#include "collision/body/feasible_poses.h"

#include <gtest/gtest.h>

#include "capsule_scene.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

using test::CapsuleBody;
using Isometry = Eigen::Isometry3d;

/// A trunk of 12 cm radius, into which an arm moves by a centimetre a second.
std::shared_ptr<const Trajectory> arm_into_trunk() {
  const CapsuleBody body(
      {{"trunk", Vec3(0, 0, 0), Vec3(0, 0.5, 0), 0.12, -1}, {"arm", Vec3(0.2, 0.1, 0), Vec3(0.2, 0.4, 0), 0.04, -1}});
  return std::make_shared<ScriptedBody>(body.surface, body.bind(), 0.0, [=](double time, std::span<Vec3> x) {
    const Isometry moves[2] = {Isometry::Identity(), Isometry(Eigen::Translation3d(-0.04 - 0.01 * time, 0, 0))};
    const std::vector<Vec3> pose = body.pose(moves);
    std::copy(pose.begin(), pose.end(), x.begin());
  });
}

struct Pose {
  CarveReport report;
  std::vector<Vec3> positions;
};

template <class Evaluate>
Pose pose(const FeasiblePoses& poses, double time, Evaluate&& evaluate) {
  std::vector<Vec3> drawn(at(poses.body().surface().vertex_count()));
  poses.body().sample(time, drawn);
  Pose out{{}, std::vector<Vec3>(at(poses.collider().vertex_count()))};
  out.report = evaluate(drawn, out.positions);
  return out;
}

TEST(FeasiblePoses, Kept_ones_are_what_an_evaluation_gives) {
  FeasiblePoses poses(arm_into_trunk(), {});
  for (const double time : {0.0, 1.0, 2.0}) {
    const Pose kept = pose(poses, time, [&](auto& drawn, auto& x) { return poses.keep(time, drawn, x); });
    const Pose again = pose(poses, time, [&](auto& drawn, auto& x) { return poses.evaluate(time, drawn, x); });
    const Pose fresh = pose(poses, time, [&](auto& drawn, auto& x) { return poses.collider().evaluate(drawn, x); });
    EXPECT_GT(fresh.report.moved_vertices, 0);
    for (const Pose* p : {&kept, &again}) {
      EXPECT_EQ(p->positions, fresh.positions);
      EXPECT_EQ(p->report.moved_vertices, fresh.report.moved_vertices);
      EXPECT_EQ(p->report.largest_move, fresh.report.largest_move);
    }
  }
}

TEST(FeasiblePoses, A_kept_one_is_not_carved_again) {
  FeasiblePoses poses(arm_into_trunk(), {});
  pose(poses, 2, [&](auto& drawn, auto& x) { return poses.keep(2, drawn, x); });
  // At another time's drawn pose the carved vertices are those that were kept.
  std::vector<Vec3> apart(at(poses.body().surface().vertex_count())), x(at(poses.collider().vertex_count()));
  poses.body().bind_pose(apart);
  EXPECT_GT(poses.evaluate(2, apart, x).moved_vertices, 0);
  EXPECT_EQ(poses.evaluate(1.5, apart, x).moved_vertices, 0);
}

TEST(FeasiblePoses, What_does_not_fit_is_not_kept) {
  FeasiblePoses poses(arm_into_trunk(), {}, 20000);
  for (int k = 0; k < 100; ++k)
    pose(poses, 2 + 0.01 * k, [&](auto& drawn, auto& x) { return poses.keep(2 + 0.01 * k, drawn, x); });
  EXPECT_GT(poses.bytes(), 10000u);
  EXPECT_LE(poses.bytes(), 20000u);
}

}  // namespace
}  // namespace ft
