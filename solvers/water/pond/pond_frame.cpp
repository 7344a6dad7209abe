// See pond_solver.h: a frame. Slices, at whose ends skins are known, of many steps each; a step kicks bodies, moves
// them, and sweeps the waves (wave_step.h), which kicks the potential by the surface at the step's start and moves the
// surface. Kicks of half a step at a slice's ends keep the whole symmetric in time.
#include "solvers/water/pond/pond_frame.h"

#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "solvers/water/pond/pond_edges.h"

namespace ft::inline solvers {
namespace {

constexpr double k_wave_step = 0.5;   ///< of the fastest wave, at most so many radians in a step
constexpr double k_body_step = 0.15;  ///< a body goes no farther in a step, in shares of its kernel's depth

}  // namespace

void PondSolver::step_slice(Frame& f, double time, int steps) const {
  const FloatWater water{setup_.gravity, setup_.density};
  const PoolBounds pool{setup_.size_x, setup_.size_z, setup_.depth};
  const double dt = time / steps;
  place_sources(floats_, f.memory.floats, f.floats);
  step_waves(modes_, f.floats.sources, 0, 0, f.eta, f.potential, f.floats.probes, f.waves);
  find_levels(floats_, f.memory.floats, f.floats);
  std::vector<RigidMotion> before;
  for (int n = 0; n <= steps; ++n) {
    const double kick = n == 0 || n == steps ? 0.5 * dt : dt;
    const double drift = n == steps ? 0 : dt;
    kick_floats(floats_, water, kick, f.floats, f.memory.floats, f.losses);
    if (n < steps) {
      before = f.memory.floats.motion;
      drift_floats(dt, f.memory.floats);
      solve_contacts(floats_, pool, f.skins, f.memory.floats, f.report.skin_pushes, f.losses);
      for (SkinPoints& s : f.skins)
        for (std::size_t v = 0; v < s.places.size(); ++v) s.places[v] += dt * s.velocities[v];
      move_sources(floats_, before, f.memory.floats, f.floats);
      if (!f.feed.empty()) {
        const double share = 1.0 / steps;
        parallel_for(f.eta.size(), 16384, [&](std::size_t b, std::size_t e) {
          for (std::size_t m = b; m < e; ++m) f.eta[m] += share * f.feed[m];
        });
      }
    }
    step_waves(modes_, f.floats.sources, kick, drift, f.eta, f.potential, f.floats.probes, f.waves);
    if (n < steps) find_levels(floats_, f.memory.floats, f.floats);
  }
  f.report.steps += steps;
}

PondReport PondSolver::advance_frame(State& state, double frame_time, std::span<const DrivenBody> driven) const {
  CHECK(frame_time > 0);
  Frame f(modes_, 1.5 * std::max(modes_.cell_x(), modes_.cell_z()));
  f.memory = memory(state);
  f.frame = state.frame;
  f.eta = *state.find("eta"), f.potential = *state.find("potential"), f.foam = *state.find("foam");
  const std::vector<double> heights = *state.find("height");
  f.heights = heights;
  const std::vector<RigidPose> floats_from = poses_of(f.memory.floats);
  f.report.driven.resize(driven.size());
  f.report.skin_pushes.assign(driven.size(), Vec3::Zero());

  double per_second = std::max(setup_.steps_per_second, fastest_ / k_wave_step);
  for (std::size_t i = 0; i < floats_.size(); ++i) {
    const double fall = f.memory.floats.motion[i].velocity.norm() + setup_.gravity * frame_time;
    per_second = std::max(per_second, fall / (k_body_step * floats_[i].shape.depth));
  }
  const int slices = begin_driven(f, driven, frame_time);
  const int steps = static_cast<int>(std::ceil(frame_time / slices * per_second - 1e-9));
  for (int slice = 0; slice < slices; ++slice) {
    cross_driven(f, driven, frame_time, slice, slices);
    step_slice(f, frame_time / slices, steps);
  }
  throw_and_land(f, driven, floats_from, frame_time);
  finish_frame(f, state, frame_time);
  return std::move(f.report);
}

void PondSolver::finish_frame(Frame& f, State& state, double frame_time) const {
  PondAccount& account = f.memory.account;
  account.slam += f.losses.slam, account.drag += f.losses.drag, account.contact += f.losses.contact;
  const auto energy = [&] { return setup_.density * wave_energy(modes_, f.eta, f.potential); };
  if (setup_.edges == PondEdge::k_open) {
    const double before = energy();
    account.outflow += absorb_at_rim(modes_, rim_keeps(modes_, setup_.rim, frame_time), f.eta, f.potential);
    account.absorbed += before - energy();
  }
  if (setup_.wind.norm() > 0) {
    const double before = energy();
    ruffle(modes_, setup_.wind.x(), setup_.wind.y(), setup_.seed, f.frame, frame_time, f.potential);
    account.wind += energy() - before;
  }
  std::vector<double> height = f.eta;
  modes_.transform.to_values(height);

  PondReport& r = f.report;
  for (std::size_t j = 0; j < at(nz()); ++j)
    for (std::size_t i = 0; i < at(nx()); ++i) {
      const double h = height[j * at(modes_.stride) + i];
      r.lowest = std::min(r.lowest, h), r.highest = std::max(r.highest, h);
    }
  r.dry = r.lowest <= -setup_.depth;
  r.in_air = static_cast<int>(f.memory.droplets.size());
  r.ledger = ledger_of(f.memory, f.eta[0]);
  r.energy.waves = energy();
  r.energy.floats = float_energy(floats_, {setup_.gravity, setup_.density}, f.memory.floats, f.floats);
  r.energy.slam = account.slam, r.energy.drag = account.drag, r.energy.contact = account.contact;
  r.energy.absorbed = account.absorbed, r.energy.wind = account.wind, r.energy.thrown = account.thrown;
  r.finite = std::isfinite(r.energy.total());
  for (const RigidMotion& m : f.memory.floats.motion)
    r.finite = r.finite && m.pose.position.allFinite() && m.spin.allFinite();

  put(f.memory, state);
  state.set("eta", std::move(f.eta));
  state.set("potential", std::move(f.potential));
  state.set("height", std::move(height));
  state.set("foam", std::move(f.foam));
  state.frame += 1;
  state.time += frame_time;
}

}  // namespace ft::inline solvers
