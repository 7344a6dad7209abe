// Where a pose has no room, against closed forms: two parallel capsules at a known distance, one that bends back on its
// own body.
#include "collision/body/room_scan.h"

#include <gtest/gtest.h>

#include "baker/core/parallel.h"
#include "capsule_scene.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

using test::CapsuleBody;
using Isometry = Eigen::Isometry3d;

constexpr double k_gap = 6e-3;

/// A trunk of 12 cm radius and an arm of 4 cm beside it; the bind pose has 20 cm between their surfaces.
CapsuleBody trunk_and_arm() {
  return CapsuleBody(
      {{"trunk", Vec3(0, 0, 0), Vec3(0, 0.5, 0), 0.12, -1}, {"arm", Vec3(0.36, 0.1, 0), Vec3(0.36, 0.4, 0), 0.04, -1}});
}

/// In a pose that holds at all times.
std::shared_ptr<FeasiblePoses> in_pose(const CapsuleBody& body, std::span<const Isometry> moves) {
  const std::vector<Vec3> pose = body.pose(moves);
  return std::make_shared<FeasiblePoses>(
      std::make_shared<ScriptedBody>(
          body.surface, body.bind(), 0.0,
          [=](double, std::span<Vec3> x) { std::copy(pose.begin(), pose.end(), x.begin()); }),
      FeasibleSettings{});
}

std::vector<TightPlace> look(const CapsuleBody& body, double arm_to) {
  const Isometry moves[2] = {Isometry::Identity(), Isometry(Eigen::Translation3d(arm_to - 0.36, 0, 0))};
  return RoomScanner(in_pose(body, moves)).look(0);
}

TEST(RoomScan, says_how_deep_a_part_is_in_another) {
  const CapsuleBody body = trunk_and_arm();
  for (const double depth : {0.0, 0.01, 0.03}) {
    const auto found = look(body, 0.16 - depth);
    ASSERT_EQ(found.size(), 1u) << depth;
    EXPECT_EQ(found[0].part_a, 1) << "the smaller gives way";
    EXPECT_EQ(found[0].part_b, 0);
    // Polygons of 20 sides: up to r (1 - cos(pi / 20)) inside their circles.
    EXPECT_NEAR(found[0].clearance, -depth, 0.16 * (1 - std::cos(std::numbers::pi / 20)) + 1e-6) << depth;
    EXPECT_NEAR(found[0].place.x(), 0.12 - depth, 0.02) << depth;
  }
}

TEST(RoomScan, is_silent_where_there_is_room) {
  const CapsuleBody body = trunk_and_arm();
  EXPECT_TRUE(look(body, 0.36).empty());
  EXPECT_TRUE(look(body, 0.16 + 1.5 * k_gap).empty());
  EXPECT_EQ(look(body, 0.16 + 0.3 * k_gap).size(), 1u) << "nearer than the gap";
}

TEST(RoomScan, does_not_count_parts_that_are_jointed) {
  CapsuleBody body(
      {{"upper", Vec3(0, 0, 0), Vec3(0, 0.3, 0), 0.05, -1}, {"lower", Vec3(0, -0.3, 0), Vec3(0, 0, 0), 0.045, 0}});
  const Isometry moves[2] = {Isometry::Identity(), Isometry(Eigen::AngleAxisd(2.6, Vec3::UnitX()))};
  EXPECT_TRUE(RoomScanner(in_pose(body, moves)).look(0).empty());
}

TEST(RoomScan, says_the_same_for_any_number_of_threads) {
  const CapsuleBody body = trunk_and_arm();
  const auto alone = [&] {
    const ThreadLimit limit(1);
    return look(body, 0.145);
  }();
  const ThreadLimit limit(3);
  const auto together = look(body, 0.145);
  ASSERT_EQ(alone.size(), together.size());
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(alone[i].clearance, together[i].clearance);
}

}  // namespace
}  // namespace ft
