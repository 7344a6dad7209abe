// The sets of the samples against what is known of them: volumes, and a pendulum's period.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "samples/tools/chair.h"
#include "samples/tools/solids.h"
#include "samples/tools/swing.h"

namespace ft::sets {
namespace {

/// Of a closed surface whose faces are seen counter-clockwise from outside; negative where they are inside out [m3].
double volume(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : triangulate(mesh)) {
    const auto p = [&](int k) -> const Vec3& { return mesh.positions[at(t[at(k)])]; };
    sum += p(0).dot(p(1).cross(p(2))) / 6;
  }
  return sum;
}

TEST(Sets, Bevelled_box_has_the_volume_of_a_box_without_its_edges) {
  const double a = 0.3, b = 0.2, c = 0.1, e = 0.01;
  // Twelve edges lose prisms of a right triangle; a corner loses its cube but for the pyramid of a sixth below its
  // face.
  const double prisms = 4 * 0.5 * e * e * (a + b + c - 6 * e), corners = 8 * e * e * e * (1 - 1.0 / 6);
  EXPECT_NEAR(volume(bevelled_box({a, b, c}, e)), a * b * c - prisms - corners, 1e-12);
}

TEST(Sets, Rod_has_the_volume_of_its_prism) {
  const int sides = 12;
  const double area = 0.5 * sides * 0.05 * 0.05 * std::sin(2 * std::numbers::pi / sides);
  EXPECT_NEAR(volume(rod(2, 0.05, sides)), 2 * area, 1e-12);
}

TEST(Sets, Chair_stands_on_the_ground_with_its_seat_at_the_height) {
  ChairSettings settings;
  const Mesh chair = make_chair(settings);
  const Box box = bounds(chair.positions);
  EXPECT_NEAR(box.lo.y(), 0, 1e-12);
  EXPECT_NEAR(box.hi.y(), settings.back, 1e-12);
  EXPECT_GT(volume(chair), 0);
}

TEST(Sets, Swing_is_a_pendulum_that_is_pumped_to_its_goal) {
  SwingSettings settings;
  settings.seconds = 40;
  const std::vector<double> angles = swing_angles(settings);
  std::vector<double> forwards;  // times at which it passes its lowest place
  double widest = 0;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    if (angles[k - 1] < 0 && angles[k] >= 0) forwards.push_back(static_cast<double>(k) / settings.fps);
    widest = std::max(widest, std::abs(angles[k]));
  }
  ASSERT_GT(forwards.size(), 8U);
  const double goal = settings.swing_deg * std::numbers::pi / 180;
  EXPECT_NEAR(widest, goal, 0.01 * goal);
  // A pendulum's period to the fourth power of its amplitude; samples are a hundredth of a second apart.
  const double square = goal * goal, period = 2 * std::numbers::pi * std::sqrt(settings.length / 9.80665) *
                                              (1 + square / 16 + 11 * square * square / 3072);
  EXPECT_NEAR(forwards.back() - forwards[forwards.size() - 2], period, 0.02);
}

}  // namespace
}  // namespace ft::sets
