#include "solvers/water/shallow/shallow_core.h"

#include <algorithm>
#include <cmath>

#include "solvers/water/shallow/shallow_solver.h"

namespace ft::inline solvers {
namespace {

/// A thinner film is no surface to be drawn: the ground is wet [m].
constexpr double k_film = 3e-4;
/// Cells that a core advances by a step in a second (tests/bench/RESULTS.md).
constexpr double k_cells_a_second = 3e7;

class ShallowCore final : public WaterCore {
 public:
  explicit ShallowCore(ShallowSolver solver) : solver_(std::move(solver)) {
    const ShallowSetup& s = solver_.setup();
    const State start = solver_.initial_state();
    const std::vector<double> depth = solver_.depths(start), surface = solver_.surface(start);
    for (std::size_t c = 0; c < depth.size(); ++c)
      still_ += s.density * s.gravity * s.cell * s.cell * depth[c] * (surface[c] - 0.5 * depth[c]);
  }

  WaterGrid grid() const override {
    const ShallowSetup& setup = solver_.setup();
    return {setup.origin, setup.cell, setup.nx, setup.nz};
  }
  int float_count() const override { return static_cast<int>(solver_.setup().floats.size()); }
  WaterCost cost(double frame_time) const override {
    const ShallowSetup& s = solver_.setup();
    double deepest = 0;
    for (std::size_t c = 0; c < s.bed.size(); ++c)
      deepest = std::max(deepest, s.depth.empty() ? s.level - s.bed[c] : s.depth[c]);
    const double speed = 0.5 * std::sqrt(s.gravity * deepest);  // of which steps are reckoned
    const double steps = std::max(1.0, std::ceil(frame_time * speed / (s.cfl * s.cell)));
    return {shallow_memory(s.nx, s.nz), steps * static_cast<double>(grid().count()) / k_cells_a_second};
  }
  State initial_state() const override { return solver_.initial_state(); }
  WaterReport advance(State& state, double frame_time, std::span<const DrivenBody> bodies) override {
    const ShallowReport done = solver_.advance_frame(state, frame_time, bodies);
    WaterReport out;
    out.ledger = done.ledger;
    out.kinetic = done.kinetic;
    out.potential = done.potential - still_ + done.floats_energy;
    out.steps = done.steps;
    out.local_steps = done.patch_steps;
    out.iterations = done.newton_iterations;
    out.unsettled = done.failed_solves;
    out.thrown = done.droplets_thrown;
    out.airborne = done.droplets;
    out.fastest = done.fastest;
    out.finite = done.finite;
    for (const WaterForce& force : done.driven)
      out.forces.push_back({force.mean, force.peak.force.norm(), force.peak.force.isZero(0) ? 0.0 : 1.0});
    return out;
  }
  WaterLedger ledger(const State& state) const override { return solver_.ledger(state); }
  void surface(const State& state, WaterSurface& out) const override {
    out.height = solver_.surface(state);
    const std::vector<double> depth = solver_.depths(state);
    out.wet.resize(depth.size());
    for (std::size_t c = 0; c < depth.size(); ++c) {
      out.wet[c] = depth[c] > k_film ? 1 : 0;
      if (out.wet[c] == 0) out.height[c] -= depth[c];
    }
  }
  void surface_flow(const State& state, std::span<Vec3> out) const override {
    const std::vector<Vec2> velocity = solver_.velocities(state);
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = Vec3(velocity[c].x(), 0, velocity[c].y());
  }
  std::span<const std::string> scalar_names() const override { return scalars_; }
  void scalar(const State& state, std::size_t, std::span<double> out) const override {
    std::ranges::copy(solver_.wet(state), out.begin());
  }
  std::vector<Droplet> droplets(const State& state) const override { return solver_.droplets(state); }
  std::vector<RigidMotion> floating(const State& state) const override { return solver_.floats(state); }

 private:
  ShallowSolver solver_;
  std::vector<std::string> scalars_{"wet"};
  double still_ = 0;  ///< potential of the columns at the start [J]
};

}  // namespace

Result<std::unique_ptr<WaterCore>> shallow_core(ShallowSetup setup) {
  auto solver = ShallowSolver::make(std::move(setup));
  if (!solver) return solver.error();
  return std::unique_ptr<WaterCore>(std::make_unique<ShallowCore>(std::move(*solver)));
}

}  // namespace ft::inline solvers
