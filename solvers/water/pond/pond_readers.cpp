// See pond_solver.h: what is read from a state.
#include <algorithm>
#include <cmath>
#include <map>

#include "baker/core/parallel.h"
#include "solvers/water/pond/pond_frame.h"

namespace ft::inline solvers {
namespace {

const std::vector<double>& block_of(const State& state, std::string_view name, std::size_t size) {
  const auto* out = state.find(name);
  CHECK(out && out->size() == size);
  return *out;
}

}  // namespace

PondMemory PondSolver::memory(const State& state) const {
  return take(state, floats_.size(), part_count_);
}

void PondSolver::surface_heights(const State& state, std::span<double> out) const {
  CHECK(out.size() == at(nx()) * at(nz()));
  const auto& height = block_of(state, "height", modes_.size());
  for (std::size_t j = 0; j < at(nz()); ++j)
    for (std::size_t i = 0; i < at(nx()); ++i)
      out[j * at(nx()) + i] = setup_.corner.y() + height[j * at(modes_.stride) + i];
}

void PondSolver::surface_flow(const State& state, std::span<Vec3> out) const {
  CHECK(out.size() == at(nx()) * at(nz()));
  std::vector<double> potential = block_of(state, "potential", modes_.size());
  modes_.transform.to_values(potential);
  const std::size_t stride = at(modes_.stride);
  parallel_for(at(nz()), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      for (std::size_t i = 0; i < at(nx()); ++i) {
        const std::size_t left = i > 0 ? i - 1 : i, right = std::min(i + 1, at(nx()) - 1);
        const std::size_t below = j > 0 ? j - 1 : j, above = std::min(j + 1, at(nz()) - 1);
        // Beyond a wall stands its mirror image: half the difference there, too.
        out[j * at(nx()) + i] = {
            (potential[j * stride + right] - potential[j * stride + left]) / (2 * modes_.cell_x()), 0,
            (potential[above * stride + i] - potential[below * stride + i]) / (2 * modes_.cell_z())};
      }
  });
}

void PondSolver::foam(const State& state, std::span<double> out) const {
  CHECK(out.size() == at(nx()) * at(nz()));
  const auto& foam = block_of(state, "foam", modes_.size());
  // Patches lie as chance has it, one over another.
  for (std::size_t j = 0; j < at(nz()); ++j)
    for (std::size_t i = 0; i < at(nx()); ++i) out[j * at(nx()) + i] = -std::expm1(-foam[j * at(modes_.stride) + i]);
}

std::vector<Droplet> PondSolver::droplets(const State& state) const {
  std::vector<Droplet> out = memory(state).droplets;
  for (Droplet& d : out) d.place += setup_.corner;
  return out;
}

std::vector<RigidMotion> PondSolver::float_motions(const State& state) const {
  std::vector<RigidMotion> out = memory(state).floats.motion;
  for (RigidMotion& m : out) m.pose.position += setup_.corner;
  return out;
}

std::vector<WaterCavity> PondSolver::cavities(const State& state) const {
  std::map<double, WaterCavity> by_body;
  for (const CavitySlice& s : memory(state).cavities) {
    WaterCavity& cavity = by_body[s.body];
    cavity.level = setup_.corner.y();
    cavity.discs.push_back(
        {setup_.corner + Vec3(s.x, -s.depth, s.z), std::sqrt(std::max(s.square, 0.0)), std::abs(s.thickness)});
  }
  std::vector<WaterCavity> out;
  for (auto& [body, cavity] : by_body) {
    // A body that has come twice has opened a depth twice: the wider one counts.
    std::ranges::sort(cavity.discs, [](const AirDisc& a, const AirDisc& b) {
      return a.centre.y() != b.centre.y() ? a.centre.y() > b.centre.y() : a.radius > b.radius;
    });
    const auto again = std::ranges::unique(cavity.discs, {}, [](const AirDisc& disc) { return disc.centre.y(); });
    cavity.discs.erase(again.begin(), again.end());
    out.push_back(std::move(cavity));
  }
  return out;
}

WaterLedger PondSolver::ledger_of(const PondMemory& memory, double mean_height) const {
  WaterLedger out;
  double bodies = memory.account.driven;
  for (const double v : memory.floats.volume) bodies += v;
  out.columns = modes_.area() * (setup_.depth + mean_height) - bodies;
  for (const Droplet& d : memory.droplets) out.droplets += d.volume;
  out.cavities = -memory.account.cavities;
  out.outflow = memory.account.outflow;
  return out;
}

WaterLedger PondSolver::ledger(const State& state) const {
  return ledger_of(memory(state), block_of(state, "eta", modes_.size())[0]);
}

PondEnergy PondSolver::energy(const State& state) const {
  PondEnergy out;
  PondMemory m = memory(state);
  std::vector<double> eta = block_of(state, "eta", modes_.size()),
                      potential = block_of(state, "potential", modes_.size());
  out.waves = setup_.density * wave_energy(modes_, eta, potential);
  FloatScratch scratch;
  WaveStepScratch waves;
  place_sources(floats_, m.floats, scratch);
  step_waves(modes_, scratch.sources, 0, 0, eta, potential, scratch.probes, waves);
  find_levels(floats_, m.floats, scratch);
  out.floats = float_energy(floats_, {setup_.gravity, setup_.density}, m.floats, scratch);
  out.slam = m.account.slam, out.drag = m.account.drag, out.contact = m.account.contact;
  out.absorbed = m.account.absorbed, out.wind = m.account.wind, out.thrown = m.account.thrown;
  return out;
}

}  // namespace ft::inline solvers
