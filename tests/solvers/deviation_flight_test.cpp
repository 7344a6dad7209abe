// Free flight against closed forms and conservation.
#include <gtest/gtest.h>

#include "solvers/standins/rigid_flight.h"

namespace ft {
namespace {

TEST(RigidFlight, A_released_body_follows_its_parabola) {
  RigidMotion release;
  release.pose.position = Vec3(1, 2, 3);
  release.velocity = Vec3(4, 5, -6);
  const RigidFlight flight(release, {0.68, 0.004 * Mat3::Identity()});
  for (const double t : {0.0, 0.1, 1.7}) {
    const RigidMotion m = flight.at(t);
    EXPECT_LT((m.pose.position - Vec3(1 + 4 * t, 2 + 5 * t - 0.5 * k_gravity * t * t, 3 - 6 * t)).norm(), 1e-14);
    EXPECT_LT((m.velocity - Vec3(4, 5 - k_gravity * t, -6)).norm(), 1e-14);
  }
}

TEST(RigidFlight, A_sphere_turns_evenly) {
  RigidMotion release;
  release.spin = Vec3(0, 0, 7);
  const RigidMotion m = RigidFlight(release, {1, 0.01 * Mat3::Identity()}).at(0.3);
  EXPECT_EQ(m.spin, release.spin);
  EXPECT_LT(m.pose.rotation.angularDistance(Quat(Eigen::AngleAxisd(2.1, Vec3::UnitZ()))), 1e-14);
}

TEST(RigidFlight, Keeps_angular_momentum_and_energy_of_a_tumbling_body) {
  RigidMass mass{1, Vec3(1, 2, 3).asDiagonal()};
  RigidMotion release;
  release.pose.rotation = Quat(0.5, 0.1, -0.7, 0.3).normalized();
  release.spin = Vec3(0.1, 6, 0.2);  // about the middle axis, nearly: it flips over
  const auto momentum = [&](const RigidMotion& m) { return Vec3(world_inertia(mass, m.pose.rotation) * m.spin); };
  const RigidFlight flight(release, mass);
  double turned = 0;
  for (const double t : {0.5, 1.0, 2.0, 4.0}) {
    const RigidMotion m = flight.at(t);
    EXPECT_LT((momentum(m) - momentum(release)).norm(), 1e-9);
    EXPECT_NEAR(m.spin.dot(momentum(m)) / release.spin.dot(momentum(release)), 1, 1e-9);
    turned = std::max(turned, (m.spin - release.spin).norm());
  }
  EXPECT_GT(turned, 1);  // it tumbles indeed
}

TEST(RigidFlight, A_spinning_top_precesses_at_its_closed_form) {
  // About the axis of symmetry of a body with moments (A, A, C), the spin circles at (C - A) / A w_z in body axes.
  const double a = 2, c = 3, wz = 5, wx = 0.4, t = 1.3;
  RigidMotion release;
  release.spin = Vec3(wx, 0, wz);
  const RigidMotion m = RigidFlight(release, {1, Vec3(a, a, c).asDiagonal()}).at(t);
  const Vec3 in_body = m.pose.rotation.conjugate() * m.spin;
  const double angle = (c - a) / a * wz * t;
  EXPECT_LT((in_body - Vec3(wx * std::cos(angle), wx * std::sin(angle), wz)).norm(), 1e-8);
}

TEST(RigidFlight, Backwards_in_time_comes_back_to_the_release) {
  RigidMotion release;
  release.spin = Vec3(1, 2, 3);
  const RigidMass mass{1, Vec3(1, 2, 2.5).asDiagonal()};
  const RigidMotion there = RigidFlight(release, mass).at(0.8);
  const RigidMotion back = RigidFlight(there, mass).at(-0.8);
  EXPECT_LT(back.pose.rotation.angularDistance(release.pose.rotation), 1e-9);
  EXPECT_LT((back.velocity - release.velocity).norm(), 1e-14);
}

}  // namespace
}  // namespace ft
