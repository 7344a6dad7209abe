// Shapes at rest. They are settled with implicit Euler and large steps, whose numerical damping brings a swinging sheet
// to rest within seconds; the shape at rest does not depend on the integrator.
#include <cmath>
#include <numbers>

#include "solvers/validation/scene_parts.h"
#include "solvers/validation/scenes.h"

namespace ft::inline solvers {
namespace {

/// Advances until nothing moves faster than `speed` [m/s], at most `frames`.
void settle(ClothRun& run, double speed, int frames) {
  for (int f = 0; f < frames; ++f) {
    run.advance();
    double fastest = 0;
    for (const Vec3& v : run.velocities()) fastest = std::max(fastest, v.norm());
    if (f > 3 && fastest < speed) return;
  }
}

ClothSetup settling(ClothSetup setup) {
  setup.bdf2 = false;
  return setup;
}

struct Droop {
  double drop;   ///< of the tip over the free length
  double angle;  ///< of the chord below the horizontal [rad]
};

/// A horizontal strip of free length L, clamped at one end, under its own weight w = B gamma / L^3 per area. The two
/// clamped rows hold the cell between them; a hinge at its edge stands for the halves of the cells beside it, so the
/// free length begins in the middle of that cell.
Droop cantilever(double gamma, int cells) {
  const double length = 0.05, mass_per_area = 0.187;
  const double cell = length / (cells + 0.5), width = 2 * cell;
  const double bend = mass_per_area * k_gravity * length * length * length / gamma;
  const Mesh mesh = rectangle_mesh(cells + 1, 2, [&](double s, double t) {
    return Vec3(s * (cells + 1) * cell - 0.5 * cell, 0, t * width);  // x from the middle of the clamped cell
  });
  ClothSetup setup = settling(accurate_setup(mesh, plain_fabric(mass_per_area, 1000, bend), 30, 1));
  std::vector<int> clamped;
  const int row = cells + 2;
  for (int j = 0; j < 3; ++j) clamped.insert(clamped.end(), {row * j, row * j + 1});
  pin_stiffly(setup, clamped, 1e11);  // softer pins turn visibly under the moment of the clamp
  ClothRun run(std::move(setup));
  settle(run, 1e-6, 600);
  const Vec3 tip = run.positions()[at(2 * row - 1)];  // middle of the free end
  return {-tip.y() / length, std::atan2(-tip.y(), tip.x())};
}

}  // namespace

std::vector<ValidationCase> validate_hanging_sheet() {
  const double height = 1, density = 0.187, stretch = 500;
  const double reference = density * k_gravity * height * height / (2 * stretch);
  std::vector<ValidationCase> out;
  double before = 0;
  for (const int n : {25, 50, 100, 200}) {
    const Mesh mesh = rectangle_mesh(n, n, [&](double s, double t) { return Vec3(s, -height * t, 0); });
    ClothSetup setup = settling(accurate_setup(mesh, plain_fabric(density, stretch, 1e-5), 24, 1));
    setup.newton_iterations = 4;
    std::vector<int> top;
    for (int i = 0; i <= n; ++i) top.push_back(i);
    pin_stiffly(setup, top);
    ClothRun run(std::move(setup));
    settle(run, 1e-6, 40);
    const auto x = run.positions();
    double upper = 0, lower = 0;
    for (int i = 0; i <= n; ++i) upper += x[at(i)].y() / (n + 1), lower += x[at(i + n * (n + 1))].y() / (n + 1);
    const double elongation = upper - lower - height;
    out.push_back(validation_case("hanging_sheet", "elongation, N = " + std::to_string(n), 1e3 * elongation,
                                  1e3 * reference, 0.02e3 * reference, "mm", "rho g H^2 / 2E"));
    if (before > 0)
      out.push_back(validation_case("hanging_sheet",
                                    "change of elongation, N = " + std::to_string(n / 2) + " to " + std::to_string(n),
                                    100 * (elongation / before - 1), 0, 0.5, "%", "mesh independence"));
    before = elongation;
  }
  return out;
}

std::vector<ValidationCase> validate_catenary() {
  // Sags for a span of 1: y = a cosh(x / a), 2 a sinh(1 / 2a) = length.
  std::vector<ValidationCase> out;
  const double sags[][2] = {{1.05, 0.13930}, {1.2, 0.29234}, {1.5, 0.50263}, {2.0, 0.79639}};
  for (const auto& row : sags) {
    const double length = row[0], sag = row[1];
    const int cells = 60;
    const double width = 2 * length / cells;
    const Mesh mesh =
        rectangle_mesh(cells, 2, [&](double s, double t) { return Vec3(length * (s - 0.5), 0, width * (t - 0.5)); });
    // A taut strip needs more stiffness to count as inextensible: its sag grows with the root of the strain.
    const double stretch = length < 1.1 ? 1e4 : 1e3;
    ClothSetup setup = settling(accurate_setup(mesh, plain_fabric(0.15, stretch, 1e-8), 24, 4));
    // Two posts far above the ends carry the pins, and move together in the first second.
    const double closing = 0.5 * (length - 1);
    setup.primary = make_boxes({{Vec3(-0.5 * length - 0.01, 1, -0.02), Vec3(-0.5 * length + 0.01, 1.02, 0.02)},
                                {Vec3(0.5 * length - 0.01, 1, -0.02), Vec3(0.5 * length + 0.01, 1.02, 0.02)}},
                               [closing](std::size_t box, double time, const Vec3& p) {
                                 const double move = closing * std::min(1.0, std::max(0.0, time));
                                 return Vec3(p + Vec3(box == 0 ? move : -move, 0, 0));
                               });
    std::vector<int> ends;
    for (int j = 0; j < 3; ++j) ends.insert(ends.end(), {j * (cells + 1), j * (cells + 1) + cells});
    pin_stiffly(setup, ends, 1e8);
    ClothRun run(std::move(setup));
    run.advance(24);
    settle(run, 1e-5, 240);
    const auto x = run.positions();
    const Vec3 &left = x[at(cells + 1)], &right = x[at(2 * cells + 1)], &middle = x[at(cells + 1 + cells / 2)];
    const double value = (0.5 * (left + right) - middle).y();
    char what[64];
    std::snprintf(what, sizeof what, "sag over span, length %.2f", length);
    out.push_back(validation_case("catenary", what, value, sag, 0.005 * sag, "1", "y = a cosh(x / a)"));
  }
  return out;
}

std::vector<ValidationCase> validate_peirce() {
  // Peirce 1930: bending length c = (B / rho g)^(1/3) is half the overhang at 41.5 degrees; B / (rho g L^3) = 1 / 8.
  std::vector<ValidationCase> out;
  for (const int cells : {10, 20, 40})
    out.push_back(validation_case("peirce_cantilever",
                                  "chord angle at twice the bending length, " + std::to_string(cells) + " cells",
                                  cantilever(8, cells).angle * 180 / std::numbers::pi, 41.5, 1.5, "degrees",
                                  "Peirce (1930), cantilever test of cloth"));
  return out;
}

std::vector<ValidationCase> validate_heavy_elastica() {
  const double table[][2] = {{1, 0.12347},  {2, 0.23851},  {5, 0.49591},  {10, 0.70020},
                             {20, 0.82988}, {50, 0.90792}, {100, 0.93752}};
  std::vector<ValidationCase> out;
  for (const auto& [gamma, drop] : table) {
    char what[64];
    std::snprintf(what, sizeof what, "drop over length, w L^3 / B = %.0f", gamma);
    out.push_back(validation_case("heavy_elastica", what, cantilever(gamma, 40).drop, drop, 0.01 * drop, "1",
                                  "heavy elastica, integrated as an ordinary differential equation"));
  }
  return out;
}

}  // namespace ft::inline solvers
