#include "solvers/water/pond/pond_core.h"

#include <algorithm>
#include <cmath>

#include "solvers/water/pond/pond_solver.h"

namespace ft::inline solvers {
namespace {

/// Waves that a core advances by a step in a second, and bytes of each (tests/bench/RESULTS.md).
constexpr double k_waves_a_second = 5e7, k_bytes = 80;

class PondCore final : public WaterCore {
 public:
  explicit PondCore(std::unique_ptr<PondSolver> solver) : solver_(std::move(solver)) {}

  WaterGrid grid() const override {
    const PondSetup& setup = solver_->setup();
    return {{setup.corner.x(), setup.corner.z()}, setup.size_x / setup.nx, setup.nx, setup.nz};
  }
  int float_count() const override { return solver_->float_count(); }
  WaterCost cost(double frame_time) const override {
    const double waves = static_cast<double>(grid().count());
    return {k_bytes * waves, waves * std::ceil(frame_time * solver_->setup().steps_per_second) / k_waves_a_second};
  }
  State initial_state() const override { return solver_->initial_state(); }
  WaterReport advance(State& state, double frame_time, std::span<const DrivenBody> bodies) override {
    const PondReport done = solver_->advance_frame(state, frame_time, bodies);
    WaterReport out;
    out.ledger = done.ledger;
    out.potential = done.energy.total();
    out.steps = done.steps;
    out.thrown = done.thrown;
    out.airborne = done.in_air;
    out.finite = done.finite;
    out.dry = done.dry;
    for (const DrivenReport& body : done.driven)
      out.forces.push_back({body.mean, body.peak.force.norm(), body.peak.force.isZero(0) ? 0.0 : 1.0});
    return out;
  }
  WaterLedger ledger(const State& state) const override { return solver_->ledger(state); }
  void surface(const State& state, WaterSurface& out) const override {
    const std::size_t count = grid().count();
    out.height.resize(count);
    out.wet.assign(count, 1);
    solver_->surface_heights(state, out.height);
  }
  void surface_flow(const State& state, std::span<Vec3> out) const override { solver_->surface_flow(state, out); }
  std::span<const std::string> scalar_names() const override { return scalars_; }
  void scalar(const State& state, std::size_t, std::span<double> out) const override { solver_->foam(state, out); }
  std::vector<Droplet> droplets(const State& state) const override { return solver_->droplets(state); }
  std::vector<WaterCavity> cavities(const State& state) const override { return solver_->cavities(state); }
  std::vector<RigidMotion> floating(const State& state) const override { return solver_->float_motions(state); }

 private:
  std::unique_ptr<PondSolver> solver_;
  std::vector<std::string> scalars_{"foam"};
};

}  // namespace

Result<std::unique_ptr<WaterCore>> pond_core(PondSetup setup) {
  auto solver = PondSolver::make(std::move(setup));
  if (!solver) return solver.error();
  return std::unique_ptr<WaterCore>(std::make_unique<PondCore>(std::move(*solver)));
}

}  // namespace ft::inline solvers
