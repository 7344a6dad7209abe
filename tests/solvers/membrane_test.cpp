// The membrane against closed forms of a sheet that is stretched evenly.
#include "solvers/energies/membrane.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solvers/cloth_patches.h"

namespace ft {
namespace {

constexpr double k_width = 0.2, k_length = 0.3;  ///< of the sheet, along weft (x) and warp (y) [m]

/// Force [N] with which its upper side holds a sheet whose points have gone from p to moved(p).
template <class Moved>
Vec3 holding_force(const Fabric& fabric, Moved&& moved) {
  const auto rest = grid_points(4, 6, [](double s, double t) { return Vec3(k_width * s, k_length * t, 0); });
  const auto triangles = grid_triangles(4, 6);
  const ClothPiece piece{0, static_cast<int>(rest.size()), fabric};
  const Membrane membrane(make_cloth_topology(rest, triangles, {&piece, 1}));
  std::vector<Vec3> x, gradient(rest.size(), Vec3::Zero());
  for (const Vec3& p : rest) x.push_back(moved(p));
  membrane.add_gradient(x, gradient);
  Vec3 force = Vec3::Zero();
  for (std::size_t i = gradient.size() - 5; i < gradient.size(); ++i) force += gradient[i];
  return force;
}

/// Force [N] that holds the sheet stretched by `strain` along its warp, its width kept.
double pull(const Fabric& fabric, double strain) {
  return holding_force(fabric, [&](const Vec3& p) { return Vec3(p.x(), (1 + strain) * p.y(), 0); }).y();
}

TEST(Membrane, A_weave_pulls_straight_beyond_its_limit_and_a_knit_does_not) {
  Fabric fabric;
  fabric.stretch_warp = 500, fabric.stretch_weft = 400, fabric.poisson = 0.3, fabric.damping = 0;
  for (const double limit : {0.0, 0.04})
    for (const double strain : {-0.02, 0.01, 0.039, 0.041, 0.06, 0.1}) {
      fabric.limit_warp = limit;
      const double green = strain + 0.5 * strain * strain, bound = limit + 0.5 * limit * limit;
      const double past = limit > 0 ? std::max(0.0, green - bound) : 0;
      const double taut = past < 0.01 ? past * past / 0.02 : past - 0.005;  // the crimp goes out over 1 %
      const double stress = 500 / (1 - 0.3 * 0.3) * green + fabric.limit_stretch * taut;
      EXPECT_NEAR(pull(fabric, strain), k_width * (1 + strain) * stress, 1e-9) << limit << " " << strain;
    }
}

TEST(Membrane, Limits_of_warp_and_weft_do_not_feel_each_other) {
  Fabric fabric;
  fabric.damping = 0;
  const double soft = pull(fabric, 0.1);
  fabric.limit_weft = 0.01;
  EXPECT_EQ(pull(fabric, 0.1), soft);
  fabric.limit_warp = 0.01;
  EXPECT_GT(pull(fabric, 0.1), 3 * soft);
}

TEST(Membrane, Yarns_that_turn_beyond_their_limit_jam_to_either_side) {
  Fabric fabric;
  fabric.shear = 80, fabric.damping = 0, fabric.limit_jam = 700;
  for (const double limit : {0.0, 0.08})
    for (const double angle : {-0.2, -0.1, -0.07, 0.07, 0.1, 0.2}) {
      fabric.limit_shear = limit;
      // The warp turns and keeps its length: no strain but 2 E12 = sin(angle).
      const Vec3 warp(std::sin(angle), std::cos(angle), 0);
      const double force =
          holding_force(fabric, [&](const Vec3& p) -> Vec3 { return Vec3(p.x(), 0, 0) + p.y() * warp; }).x();
      const double past = limit > 0 ? std::max(0.0, std::abs(std::sin(angle)) - std::sin(limit)) : 0;
      const double jammed = past < 0.05 ? past * past / 0.1 : past - 0.025;  // they jam over a shear of 0.05
      const double stress = 80 * std::sin(angle) + std::copysign(700 * jammed, angle);
      EXPECT_NEAR(force, k_width * stress, 1e-9) << limit << " " << angle;
    }
}

/// Stiffness [N/m] against raising the top of a triangle whose base is `length` long, above `place` of it.
double stiffness_of_top(double length, double height, double place) {
  const std::vector<Vec3> rest{{0, 0, 0}, {length, 0, 0}, {place * length, height, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}};
  Fabric fabric;
  fabric.stretch_warp = fabric.stretch_weft = 500, fabric.poisson = 0, fabric.damping = 0;
  const ClothPiece piece{0, 3, fabric};
  const ClothTopology topology = make_cloth_topology(rest, triangles, {&piece, 1});
  std::vector<Vec3> x = rest, gradient(3, Vec3::Zero());
  const double raised = 1e-5 * height;
  x[2].y() += raised;
  Membrane(topology).add_gradient(x, gradient);
  return gradient[2].y() / raised;
}

TEST(Membrane, Caps_get_softer_the_flatter_they_are_and_other_triangles_do_not) {
  constexpr double length = 0.02, thickest = 0.02;
  for (const double flatness : {1.0, 0.1, 0.03, 0.021})
    EXPECT_NEAR(stiffness_of_top(length, flatness * length, 0.4) * flatness / 250, 1, 1e-4) << flatness;
  for (const double flatness : {0.019, 0.01, 1e-3, 1e-4}) {
    EXPECT_NEAR(stiffness_of_top(length, flatness * length, 0.4) * thickest * thickest / flatness / 250, 1, 1e-4)
        << flatness;
    EXPECT_NEAR(stiffness_of_top(length, flatness * length, 1) * flatness / 250, 1, 1e-4) << "a needle";
  }
}

}  // namespace
}  // namespace ft
