#include "samples/tools/swing.h"

#include <cmath>
#include <numbers>

#include "samples/tools/solids.h"
#include "samples/tools/swing_times.h"

namespace ft::sets {
namespace {

constexpr double k_board_width = 0.50, k_board_depth = 0.19, k_board = 0.028, k_rope = 0.008;  // m

}  // namespace

std::vector<double> swing_angles(const SwingSettings& settings) {
  const double rad = std::numbers::pi / 180, w2 = k_gravity / settings.length;
  const double goal = w2 * (1 - std::cos(settings.swing_deg * rad));  // energy over m L^2
  // Pumping: in step with the speed, weaker the nearer to the goal; half of the growth within a period and a half.
  const auto acceleration = [&](double angle, double speed) {
    const double energy = 0.5 * speed * speed + w2 * (1 - std::cos(angle));
    return -w2 * std::sin(angle) + k_pumping * speed * (1 - energy / goal);
  };
  const int steps = 20;  // a sample: below half a millisecond
  const double h = 1 / (settings.fps * steps);
  double angle = -settings.start_deg * rad, speed = 0;
  std::vector<double> out;
  for (int sample = 0; sample / settings.fps <= settings.seconds; ++sample) {
    out.push_back(angle);
    if (sample / settings.fps < k_let_go) continue;
    for (int k = 0; k < steps; ++k) {  // midpoint rule
      const double middle = angle + 0.5 * h * speed, middle_speed = speed + 0.5 * h * acceleration(angle, speed);
      angle += h * middle_speed;
      speed += h * acceleration(middle, middle_speed);
    }
  }
  return out;
}

Mesh make_swing(const SwingSettings& settings, double angle) {
  Mesh flat;
  flat.name = "swing";
  const double l = settings.length;
  add(flat, bevelled_box({k_board_width, k_board, k_board_depth}, 0.008),
      Eigen::Isometry3d(Eigen::Translation3d(0, -l - 0.5 * k_board, 0)));
  for (const double x : {-k_rope_side, k_rope_side})
    add(flat, rod(l - 2e-3, k_rope, 8), Eigen::Isometry3d(Eigen::Translation3d(x, -0.5 * l, 0)));
  const Eigen::Isometry3d turn =
      Eigen::Translation3d(0, l + settings.seat, 0) * Eigen::AngleAxisd(-angle, Vec3::UnitX());
  for (Vec3& p : flat.positions) p = turn * p;
  return flat;
}

Mesh make_swing_frame(const SwingSettings& settings) {
  constexpr double k_radius = 0.035, k_reach = 0.75, k_spread = 0.85;  // m
  const double top = settings.length + settings.seat + k_radius + 5e-3;
  Mesh out;
  out.name = "frame";
  const auto pole = [&](const Vec3& from, const Vec3& to) {
    add(out, rod((to - from).norm(), k_radius, 12), between(from, to));
  };
  pole({-k_reach, top, 0}, {k_reach, top, 0});
  for (const double x : {-1.0, 1.0})
    for (const double z : {-k_spread, k_spread})
      pole({x * (k_reach + 0.2), 0, z}, {x * (k_reach - 0.05), top - 2 * k_radius, z > 0 ? 0.04 : -0.04});
  return out;
}

}  // namespace ft::sets
