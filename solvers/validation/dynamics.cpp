// Free motion: falling, flying, order of accuracy, drag.
#include <cmath>

#include "solvers/energies/cloth_topology.h"
#include "solvers/validation/scene_parts.h"
#include "solvers/validation/scenes.h"

namespace ft::inline solvers {
namespace {

std::vector<double> masses(const Mesh& mesh, const Fabric& fabric) {
  const ClothPiece pieces[] = {{0, mesh.vertex_count(), fabric}};
  return make_cloth_topology(mesh.positions, triangulate(mesh), pieces).mass;
}

double mean_height(const ClothRun& run) {
  const auto x = run.positions();
  double sum = 0;
  for (const Vec3& p : x) sum += p.y();
  return sum / static_cast<double>(x.size());
}

struct Momentum {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double size = 0, angular_size = 0;  ///< sums of the absolute values
};

Momentum momentum(const ClothRun& run, const std::vector<double>& mass) {
  Momentum m;
  const auto x = run.positions(), v = run.velocities();
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const Vec3 p = mass[i] * v[i], l = x[i].cross(p);
    m.linear += p, m.angular += l, m.size += p.norm(), m.angular_size += l.norm();
  }
  return m;
}

/// Largest change of linear and of angular momentum over a second of flight, relative to the sums of the parts.
std::array<double, 2> momentum_change(bool folds) {
  const double side = 0.5;
  const Mesh mesh =
      rectangle_mesh(16, 16, [&](double s, double t) { return Vec3(side * (s - 0.5), 0, side * (t - 0.5)); });
  const Fabric fabric = plain_fabric(0.15, 500, 1e-4, 0.3);
  const auto mass = masses(mesh, fabric);
  ClothSetup setup = accurate_setup(mesh, fabric, 24, 64);
  setup.gravity.setZero();
  setup.garments[0].self_collision = folds;
  // Friction acts on two surfaces that are a gap apart: its couple (gap times force) is real, 8e-5 in this scene, and
  // left out here.
  setup.garments[0].self_friction = 0;
  ClothRun run(std::move(setup));
  run.set_velocity([folds](const Vec3& p) {
    const Vec3 spin = Vec3(0.4, 1.0, 0.2).cross(p);
    return Vec3(Vec3(0.3, 0.5, -0.2) + spin +
                (folds ? Vec3(0, 6 * std::abs(p.x()), 0) : Vec3(0, 0.5 * std::sin(8 * p.x()), 0)));
  });
  const Momentum start = momentum(run, mass);
  std::array<double, 2> worst{0, 0};
  for (int f = 0; f < 24; ++f) {
    run.advance();
    const Momentum now = momentum(run, mass);
    worst[0] = std::max(worst[0], (now.linear - start.linear).norm() / start.size);
    worst[1] = std::max(worst[1], (now.angular - start.angular).norm() / start.angular_size);
  }
  return worst;
}

}  // namespace

std::vector<ValidationCase> validate_free_fall() {
  const double g = 9.81, seconds = 2, fps = 24;
  const auto fall = [&](bool bdf2, int substeps) {
    const Mesh mesh =
        rectangle_mesh(8, 8, [](double s, double t) { return Vec3(0.5 * s, 0.3 * std::sin(3 * s), 0.5 * t); });
    ClothSetup setup = accurate_setup(mesh, plain_fabric(0.15, 500, 1e-5), fps, substeps);
    setup.garments[0].fabric.damping = 0.01;  // damping of the fabric does not brake
    setup.gravity = Vec3(0, -g, 0);
    setup.bdf2 = bdf2;
    ClothRun run(std::move(setup));
    const double before = mean_height(run);
    run.advance(static_cast<int>(seconds * fps));
    return mean_height(run) - before;
  };
  const double exact = -0.5 * g * seconds * seconds, h = 1 / (fps * 4);
  return {validation_case("free_fall", "way in 2 s, multistep, 4 substeps", fall(true, 4), exact, 1e-9 * -exact, "m",
                          "g t^2 / 2"),
          validation_case("free_fall", "way in 2 s, multistep, 1 substep", fall(true, 1), exact, 1e-9 * -exact, "m",
                          "g t^2 / 2"),
          validation_case("free_fall", "way in 2 s, implicit Euler, 4 substeps", fall(false, 4),
                          exact - 0.5 * g * h * seconds, 1e-9 * -exact, "m", "g t^2 / 2 + g h t / 2, its known error")};
}

namespace {

std::vector<ValidationCase> momentum_rows(const std::string& name, bool folds) {
  const auto change = momentum_change(folds);
  return {validation_case(name, "change of momentum in 1 s", change[0], 0, 1e-5, "1", "Newton's third law"),
          validation_case(name, "change of angular momentum in 1 s", change[1], 0, 1e-5, "1", "Newton's third law")};
}

}  // namespace

std::vector<ValidationCase> validate_free_flight() {
  return momentum_rows("free_flight", false);
}
std::vector<ValidationCase> validate_folding_flight() {
  return momentum_rows("folding_flight", true);
}

std::vector<ValidationCase> validate_substep_invariance() {
  // A damped sheet, held at one edge, swings down in air.
  const auto end = [](int substeps) {
    const Mesh mesh = rectangle_mesh(6, 6, [](double s, double t) { return Vec3(0.3 * s, 0, 0.3 * t); });
    Fabric fabric = plain_fabric(0.15, 60, 1e-4, 0.3);
    fabric.damping = 5e-3;
    ClothSetup setup = accurate_setup(mesh, fabric, 24, substeps);
    setup.air_density = 1.225;
    setup.newton_iterations = 12;
    std::vector<int> edge;
    for (int i = 0; i <= 6; ++i) edge.push_back(i);
    pin_stiffly(setup, edge, 1e6);
    ClothRun run(std::move(setup));
    run.advance(6);
    return run.positions();
  };
  const auto distance = [](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(a.size()));
  };
  const auto a = end(16), b = end(32), c = end(64);
  return {validation_case("substep_invariance", "ratio of the changes from h to h/2 and from h/2 to h/4",
                          distance(a, b) / distance(b, c), 4, 0.7, "1", "second order of the integrator")};
}

std::vector<ValidationCase> validate_terminal_velocity() {
  const double mass_per_area = 0.15, density = 1.225;
  const Mesh mesh = rectangle_mesh(4, 4, [](double s, double t) { return Vec3(0.1 * s, 0, 0.1 * t); });
  ClothSetup setup = accurate_setup(mesh, plain_fabric(mass_per_area, 1e3, 1e-2), 24, 4);
  setup.air_density = density;
  const double drag = setup.garments[0].fabric.drag_normal;
  ClothRun run(std::move(setup));
  run.advance(47);
  const double before = mean_height(run);
  run.advance();
  const double speed = (before - mean_height(run)) * 24,
               reference = std::sqrt(2 * mass_per_area * k_gravity / (density * drag));
  return {validation_case("terminal_velocity", "speed after 2 s", speed, reference, 0.03 * reference, "m/s",
                          "rho Cn A v^2 / 2 = m g")};
}

}  // namespace ft::inline solvers
