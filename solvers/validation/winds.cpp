// Moving air: what it does to cloth, and what bodies do to it.
#include <cmath>
#include <numbers>

#include "solvers/validation/scene_parts.h"
#include "solvers/validation/scenes.h"
#include "solvers/wind/body_paths.h"
#include "solvers/wind/registry.h"

namespace ft::inline solvers {
namespace {

constexpr double k_degree = std::numbers::pi / 180;

/// From the vertical [degrees].
double angle_in_wind(double speed) {
  const double start = 45 * k_degree, length = 0.3;
  // Four cells, stiff, hung by the upper edge.
  const Mesh mesh = rectangle_mesh(2, 2, [&](double s, double t) {
    return Vec3(length * t * std::sin(start), -length * t * std::cos(start), length * s);
  });
  ClothSetup setup = accurate_setup(mesh, plain_fabric(0.15, 1e4, 1), 24, 8);
  setup.air_density = 1.225;
  setup.wind = steady_wind(Vec3(speed, 0, 0));
  pin_stiffly(setup, {0, 1, 2});
  ClothRun run(std::move(setup));
  run.advance(24 * 12);
  const std::vector<Vec3> x = run.positions();
  const Vec3 way = x[7] - x[1];
  return std::atan2(way.x(), -way.y()) / k_degree;
}

}  // namespace

std::vector<ValidationCase> validate_hinged_panel() {
  const double table[][2] = {{2, 51.31}, {5, 73.90}, {10, 81.91}};
  std::vector<ValidationCase> out;
  for (const auto& [speed, angle] : table)
    out.push_back(validation_case("hinged_panel", "angle from the vertical at " + std::to_string(int(speed)) + " m/s",
                                  angle_in_wind(speed), angle, 0.3, "degrees", "rho Cn U^2 cos^2 / 2 = sigma g sin"));
  return out;
}

std::vector<ValidationCase> validate_wake() {
  constexpr double k_speed = 7, k_drag_area = 0.6, k_interval = 1.0 / 48, k_first = -6;
  BodyPath path;
  path.drag_area = k_drag_area;
  for (int s = 0; s <= 300; ++s) {
    path.centres.emplace_back(k_speed * (k_first + s * k_interval), 0, 0);
    path.velocities.emplace_back(k_speed, 0, 0);
  }
  WindFieldSpec spec;
  spec.kind = "wake";
  spec.bodies = std::make_shared<BodyPaths>(std::vector<BodyPath>{path}, k_first, k_interval);
  const auto field = make_wind_field(spec);
  std::vector<ValidationCase> out;
  if (!field) return out;
  const auto air = (*field)->at_time(0);
  for (const double behind : {1.0, 3.0, 9.0}) {
    double flow = 0;
    constexpr double k_cell = 0.05, k_half = 5;
    for (double y = -k_half; y < k_half; y += k_cell)
      for (double z = -k_half; z < k_half; z += k_cell)
        flow += k_cell * k_cell * air->velocity(Vec3(-behind, y, z)).x();
    out.push_back(
        validation_case("wake", "momentum through a plane " + std::to_string(int(behind)) + " m behind a body",
                        k_speed * flow, 0.5 * k_speed * k_speed * k_drag_area,
                        0.1 * 0.5 * k_speed * k_speed * k_drag_area, "m4/s2", "its drag by rho, U^2 C_d A / 2"));
  }
  return out;
}

}  // namespace ft::inline solvers
