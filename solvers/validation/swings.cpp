// Swings. The pendulum is one triangle: two corners are its axis, the lumped mass of the third is the bob.
#include <cmath>
#include <numbers>

#include "solvers/validation/scene_parts.h"
#include "solvers/validation/scenes.h"

namespace ft::inline solvers {
namespace {

constexpr double k_degree = std::numbers::pi / 180;
constexpr double k_length = 1;

double angle_of(const Vec3& bob) {
  return std::atan2(bob.z(), -bob.y());
}

ClothSetup pendulum(double angle, double fps, int substeps) {
  const std::vector<Vec3> points = {Vec3(-0.25, 0, 0), Vec3(0.25, 0, 0),
                                    Vec3(0, -k_length * std::cos(angle), k_length * std::sin(angle))};
  const Triangle triangle[] = {{0, 1, 2}};
  ClothSetup setup =
      accurate_setup(make_triangle_mesh("pendulum", points, triangle), plain_fabric(0.15, 1e5, 0), fps, substeps);
  pin_stiffly(setup, {0, 1}, 1e7);
  return setup;
}

/// Time from the first to the third passage through the lowest point [s].
double measure_period(ClothRun& run) {
  double before = angle_of(run.positions()[2]), t_before = 0, first = 0;
  for (int crossings = 0, f = 0; f < 100000; ++f) {
    run.advance();
    const double now = angle_of(run.positions()[2]);
    if ((now < 0) != (before < 0)) {
      const double t = t_before + (run.time() - t_before) * before / (before - now);
      if (++crossings == 1) first = t;
      if (crossings == 3) return t - first;
    }
    before = now, t_before = run.time();
  }
  return std::nan("");
}

double energy_per_mass(const ClothRun& run) {
  return k_gravity * run.positions()[2].y() + 0.5 * run.velocities()[2].squaredNorm();
}

}  // namespace

std::vector<ValidationCase> validate_pendulum_period() {
  const double table[][2] = {{10, 1.001907}, {30, 1.017409}, {60, 1.073182}, {90, 1.180341}, {120, 1.372881}};
  std::vector<ValidationCase> out;
  for (const auto& [angle, ratio] : table) {
    ClothRun run(pendulum(angle * k_degree, 1000, 1));
    char what[64];
    std::snprintf(what, sizeof what, "period over 2 pi sqrt(L/g), %.0f degrees", angle);
    out.push_back(validation_case("pendulum_period", what,
                                  measure_period(run) / (2 * std::numbers::pi * std::sqrt(k_length / k_gravity)), ratio,
                                  1e-3 * ratio, "1", "2 K(sin(angle/2)) / pi"));
  }
  return out;
}

std::vector<ValidationCase> validate_pendulum_energy() {
  ClothRun run(pendulum(90 * k_degree, 1000, 1));
  const double start = energy_per_mass(run), lowest = -k_gravity * k_length;
  run.advance(60000);
  return {validation_case("pendulum_energy", "loss in 60 s from 90 degrees, 1 ms",
                          100 * (start - energy_per_mass(run)) / (start - lowest), 0, 0.05, "%", "conservation")};
}

std::vector<ValidationCase> validate_swing_at_default_settings() {
  const ClothSetup standard;
  ClothSetup setup = pendulum(30 * k_degree, standard.fps, standard.min_substeps);
  setup.newton_iterations = standard.newton_iterations;
  setup.linear_tolerance = standard.linear_tolerance;
  setup.garments[0].fabric = Fabric();
  setup.garments[0].pins[0].stiffness = ClothPin().stiffness;
  ClothRun timed(setup), run(setup);
  const double period = 1.017409 * 2 * std::numbers::pi * std::sqrt(k_length / k_gravity);
  const double start = energy_per_mass(run), lowest = -k_gravity * k_length;
  run.advance(static_cast<int>(std::lround(10 * period * standard.fps)));
  return {validation_case("swing_at_default_settings", "period from 30 degrees", measure_period(timed), period,
                          0.005 * period, "s", "2 pi sqrt(L/g) times the amplitude's series"),
          validation_case("swing_at_default_settings", "energy lost in ten periods",
                          100 * (start - energy_per_mass(run)) / (start - lowest), 0, 1, "%", "conservation")};
}

std::vector<ValidationCase> validate_hanging_chain() {
  const double length = 0.3, tilt = 1 * k_degree;
  const int cells = 60;
  const double cell = length / cells;
  const Mesh mesh = rectangle_mesh(2, cells, [&](double s, double t) {
    return Vec3(2 * cell * s, -length * t * std::cos(tilt), length * t * std::sin(tilt));
  });
  ClothSetup setup = accurate_setup(mesh, plain_fabric(0.15, 1e4, 0), 500, 1);
  pin_stiffly(setup, {0, 1, 2});
  ClothRun run(std::move(setup));
  // Amplitude of the first mode J0(2.40483 sqrt(s / L)), s from the free end; the others are orthogonal to it.
  const auto amplitude = [&] {
    const auto x = run.positions();
    double sum = 0;
    for (int j = 0; j <= cells; ++j) {
      const double s = 1 - static_cast<double>(j) / cells;
      sum += (j == cells ? 0.5 : 1.0) * x[at(3 * j + 1)].z() * std::cyl_bessel_j(0.0, 2.404825558 * std::sqrt(s));
    }
    return sum;
  };
  // Ten passages through zero are nine half periods.
  double before = amplitude(), t_before = 0, first = 0, last = 0;
  for (int crossings = 0, f = 0; f < 5000 && crossings < 10; ++f) {
    run.advance();
    const double now = amplitude();
    if ((now < 0) != (before < 0)) {
      last = t_before + (run.time() - t_before) * before / (before - now);
      if (++crossings == 1) first = last;
    }
    before = now, t_before = run.time();
  }
  const double frequency = 4.5 / (last - first),
               reference = 1.20241 * std::sqrt(k_gravity / length) / (2 * std::numbers::pi);
  return {validation_case("hanging_chain", "frequency of the first mode", frequency, reference, 0.01 * reference, "Hz",
                          "Bernoulli: 1.20241 sqrt(g / L)")};
}

}  // namespace ft::inline solvers
