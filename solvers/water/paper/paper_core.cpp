#include "solvers/water/paper/paper_core.h"

#include <algorithm>
#include <cmath>

#include "solvers/water/paper/paper_solver.h"

namespace ft::inline solvers {
namespace {

/// A thinner film is no surface to be drawn: the ground is wet [m].
constexpr double k_film = 3e-4;
/// Cells that a core advances by a step in a second (tests/bench/RESULTS.md).
constexpr double k_cells_a_second = 1e7;

class PaperCore final : public WaterCore {
 public:
  explicit PaperCore(PaperSolver solver) : solver_(std::move(solver)) {}

  WaterGrid grid() const override {
    const PaperSetup& setup = solver_.setup();
    return {setup.origin, setup.cell, setup.nx, setup.nz};
  }
  int float_count() const override { return static_cast<int>(solver_.setup().floats.size()); }
  WaterCost cost(double frame_time) const override {
    const PaperSetup& s = solver_.setup();
    const std::vector<double> depth = solver_.depths(solver_.initial_state());
    const double speed = std::sqrt(s.gravity * *std::max_element(depth.begin(), depth.end()));
    const double steps = std::max(1.0, std::ceil(frame_time * speed / (s.cfl * s.cell)));
    return {paper_memory(s.nx, s.nz), steps * static_cast<double>(grid().count()) / k_cells_a_second};
  }
  State initial_state() const override { return solver_.initial_state(); }
  WaterReport advance(State& state, double frame_time, std::span<const DrivenBody> bodies) override {
    return solver_.advance_frame(state, frame_time, bodies);
  }
  WaterLedger ledger(const State& state) const override { return solver_.ledger(state); }
  void surface(const State& state, WaterSurface& out) const override {
    out.height = solver_.tops(state);
    const std::vector<double> depth = solver_.depths(state);
    out.wet.resize(depth.size());
    for (std::size_t c = 0; c < depth.size(); ++c) {
      out.wet[c] = depth[c] > k_film ? 1 : 0;
      if (out.wet[c] == 0) out.height[c] = solver_.bed(c);
    }
  }
  void surface_flow(const State& state, std::span<Vec3> out) const override {
    const std::vector<Vec2> velocity = solver_.velocities(state);
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = Vec3(velocity[c].x(), 0, velocity[c].y());
  }
  std::vector<Droplet> droplets(const State& state) const override { return solver_.droplets(state); }
  std::vector<RigidMotion> floating(const State& state) const override { return solver_.floats(state); }

 private:
  PaperSolver solver_;
};

}  // namespace

Result<std::unique_ptr<WaterCore>> paper_core(PaperSetup setup) {
  auto solver = PaperSolver::make(std::move(setup));
  if (!solver) return solver.error();
  return std::unique_ptr<WaterCore>(std::make_unique<PaperCore>(std::move(*solver)));
}

}  // namespace ft::inline solvers
