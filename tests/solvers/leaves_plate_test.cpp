// The law of plates against two dimensions: what flutters and what tumbles, where one becomes the other, how fast
// tumbling goes; and that a plate that starts in a plane stays there. The plate is the three-dimensional one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solvers/leaves/plate_aerodynamics.h"

namespace ft {
namespace {

constexpr double k_density = 1.225;
const Vec3 k_down(0, -k_gravity, 0);

enum class Fall { k_flutters, k_tumbles, k_neither };

struct Fallen {
  Fall kind;
  double turns_per_second;
  double out_of_plane;  ///< m
};

/// A strip of span 1 m whose mass is i_star rho pi a^2 per span, as Andersen et al. count: an ellipse in its section,
/// or of even thickness.
PlateModel strip(double half_chord, double i_star, bool ellipse, double thickness_ratio, const PlateCoefficients& law) {
  PlateModel p;
  p.law = law;
  p.air_density = k_density;
  p.area = 2 * half_chord;
  p.half_chord = Vec3(half_chord, half_chord, 0.5);
  p.mass = i_star * k_density * std::numbers::pi * half_chord * half_chord;
  const double share = ellipse ? 0.25 * (1 + thickness_ratio * thickness_ratio) : 1.0 / 3;
  p.inertia = p.mass * Vec3(share * half_chord * half_chord, 1.0 / 12, 1.0 / 12);
  add_air(p, false, thickness_ratio);
  return p;
}

/// Of the second half of so many seconds.
Fallen fall(const PlateModel& plate, double tilt, double seconds) {
  PlateMotion m;
  m.turn = Quat(Eigen::AngleAxisd(tilt, Vec3::UnitX()));
  double angle = 0, least = 0, most = 0, first = 0;
  const int count = static_cast<int>(seconds / 0.01);
  for (int k = 0; k < count; ++k) {
    advance_plate(plate, k_down, {}, 0.01, 1000, m);
    angle += 0.01 * m.spin[0];
    if (k == count / 2) first = least = most = angle;
    least = std::min(least, angle), most = std::max(most, angle);
  }
  const double net = std::abs(angle - first) / (2 * std::numbers::pi), range = (most - least) / (2 * std::numbers::pi);
  const Fall kind = range < 0.5 ? Fall::k_flutters : net > 3 && net > 0.8 * range ? Fall::k_tumbles : Fall::k_neither;
  return {kind, net / (0.5 * seconds), std::abs(m.place.x())};
}

TEST(LeafPlates, The_strip_of_Andersen_flutters_when_light_and_tumbles_when_heavy) {
  for (const double tilt : {0.2, 0.5, 1.0}) {
    for (const double i_star : {0.3, 0.5, 0.8, 1.0})
      EXPECT_EQ(fall(strip(0.05, i_star, true, 0.1, strip_coefficients()), tilt, 20).kind, Fall::k_flutters) << i_star;
    for (const double i_star : {1.3, 1.4}) {
      const Fallen f = fall(strip(0.05, i_star, true, 0.1, strip_coefficients()), tilt, 20);
      EXPECT_EQ(f.kind, Fall::k_tumbles) << i_star;
      EXPECT_EQ(f.out_of_plane, 0);
    }
  }
}

TEST(LeafPlates, A_plate_with_the_coefficients_of_leaves_begins_to_tumble_at_Belmontes_Froude_number) {
  // Fr = sqrt(M / (rho L^2 w)) = sqrt(pi I* / 4): flat plates, their chord from 10 to 20 cm at 80 g/m2.
  const auto kind_at = [](double froude) {
    const double i_star = 4 * froude * froude / std::numbers::pi;
    return fall(strip(0.05, i_star, false, 0, PlateCoefficients{}), 0.3, 24).kind;
  };
  double last_flutter = 0, first_tumble = 0;
  for (double froude = 0.5; froude < 0.9; froude += 0.01) {
    const Fall kind = kind_at(froude);
    if (kind == Fall::k_flutters && first_tumble == 0) last_flutter = froude;
    if (kind == Fall::k_tumbles && first_tumble == 0) first_tumble = froude;
  }
  const double boundary = 0.5 * (last_flutter + first_tumble);
  printf("flutters up to Fr %.2f, tumbles from %.2f\n", last_flutter, first_tumble);
  EXPECT_NEAR(boundary, 0.67, 0.05);
}

TEST(LeafPlates, Tumbling_gets_faster_with_the_root_of_thickness_and_slower_with_width) {
  // Omega ~ d^1/2 / w (Mahadevan, Ryu and Samuel 1999). Thickness as mass per area at one density: d ~ I* w.
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  int count = 0;
  for (const double half_chord : {0.01, 0.02, 0.04, 0.08})
    for (const double i_star : {1.25, 1.3, 1.35, 1.4}) {
      const Fallen f = fall(strip(half_chord, i_star, true, 0.1, strip_coefficients()), 0.2, 20);
      if (f.kind != Fall::k_tumbles) continue;
      const double x = std::log(std::sqrt(i_star * half_chord) / half_chord), y = std::log(f.turns_per_second);
      sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
      ++count;
    }
  ASSERT_GE(count, 12);
  const double slope = (count * sum_xy - sum_x * sum_y) / (count * sum_xx - sum_x * sum_x);
  printf("slope %.3f of %d\n", slope, count);
  EXPECT_NEAR(slope, 1, 0.15);
}

TEST(LeafPlates, Drag_and_lift_take_no_energy_from_nowhere) {
  // In still air without gravity the energy, added mass with it, only falls; also of a folded plate.
  PlateModel p = strip(0.03, 0.7, false, 0, PlateCoefficients{});
  p.half_chord = Vec3(0.025, 0.03, 0.04);
  p.fold = 0.3, p.panel_arm = 0.012;
  p.inertia = p.mass * Vec3(2e-4, 7e-4, 5e-4);
  add_air(p, true);
  PlateMotion m;
  m.velocity = Vec3(3, -2, 1), m.spin = Vec3(20, 5, -30);
  const auto energy = [&] {
    return m.velocity.dot(p.masses().cwiseProduct(m.velocity)) + m.spin.dot(p.inertias().cwiseProduct(m.spin));
  };
  double before = energy();
  for (int k = 0; k < 400; ++k) {
    advance_plate(p, Vec3::Zero(), {}, 0.002, 100, m);
    const double now = energy();
    EXPECT_LE(now, before * (1 + 1e-4)) << k;
    before = now;
  }
}

TEST(LeafPlates, One_step_that_is_far_too_long_stays_finite) {
  PlateModel p = strip(0.03, 0.01, false, 0, PlateCoefficients{});
  p.inertia = p.mass * Vec3(2e-4, 7e-4, 5e-4);
  PlateMotion m;
  m.velocity = Vec3(300, -200, 100), m.spin = Vec3(2000, 500, -3000);
  advance_plate(p, k_down, {Vec3(100, 0, 0), Vec3(1e4, 0, 0)}, 0.04, 1, m);
  EXPECT_TRUE(m.place.allFinite() && m.velocity.allFinite() && m.spin.allFinite() && m.turn.coeffs().allFinite());
  EXPECT_LT(m.velocity.norm(), 1000);
}

}  // namespace
}  // namespace ft
