// See shallow_frame.h: plans, long steps and the patch's own.
#include "solvers/water/shallow/shallow_frame.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

/// Cells between what is fast or near a body and the rim of the patch.
constexpr int k_margin = 8;
/// Of these next to the rim, so many must stay slow enough for the long step, as a multiple of dx/dt.
constexpr int k_rim = 3;
constexpr double k_rim_cfl = 0.45;
/// What steps cost, in cells of the whole's: a cell of a patch, and a step near bodies beside its cells. Only which
/// steps are taken hangs on it.
constexpr double k_patch_cost = 1.3, k_near_cost = 20000;
/// Candidates for the long step: each is for water half as fast as that of the one before.
constexpr int k_candidates = 10;

CellBox aligned(const CellBox& box, int nx, int nz) {
  if (box.empty()) return {};
  constexpr int t = k_speed_tile;
  return {box.i0 / t * t, box.k0 / t * t, std::min(nx, (box.i1 + t - 1) / t * t),
          std::min(nz, (box.k1 + t - 1) / t * t)};
}

double fastest_in(const std::vector<double>& speeds, int across, const CellBox& box) {
  double most = 0;
  constexpr int t = k_speed_tile;
  for (int k = box.k0 / t; k < (box.k1 + t - 1) / t; ++k)
    for (int i = box.i0 / t; i < (box.i1 + t - 1) / t; ++i) most = std::max(most, speeds[at(i) + at(across) * at(k)]);
  return most;
}

}  // namespace

ShallowFrame::ShallowFrame(const ShallowSetup& setup, std::span<const FloatingHull> floats, ShallowScratch& scratch,
                           std::span<const DrivenBody> driven, double frame_time, std::uint64_t number)
    : setup_(setup),
      models_(floats),
      s_(scratch),
      laws_{setup.gravity, setup.manning, setup.viscosity},
      near_(near_laws(setup)),
      met_(driven, bodies_of(floats)),
      frame_time_(frame_time),
      number_(number) {
  const std::size_t count = s_.driven.size() + models_.size();
  s_.bodies.assign(count, {});
  s_.float_places.resize(models_.size());
  for (std::size_t b = 0; b < s_.driven.size(); ++b)
    s_.bodies[b].surface = {s_.driven[b].triangles, s_.driven[b].places};
  for (std::size_t b = 0; b < models_.size(); ++b) s_.bodies[s_.driven.size() + b].floats = true;
  impulse_.assign(count, Vec6::Zero());
  peak_.resize(count);
  s_.near.newton_count = s_.near.linear_count = s_.near.failed_count = 0;
  s_.step = 0;
}

double ShallowFrame::make_room() {
  if (s_.driven.empty()) return 0;
  place_bodies(0);
  Flow& f = s_.flow;
  s_.near.find(f, std::span(s_.bodies).first(s_.driven.size()), setup_.origin.x(), setup_.origin.y(), near_);
  double taken = 0;
  for (const NearWater::Cell& cell : s_.near.cells()) {
    if (cell.begin == cell.end) continue;
    const double room = std::max(0.0, s_.near.holds(f, cell, cell.head0));
    if (room >= f.h[cell.c]) continue;
    taken += f.h[cell.c] - room;
    f.h[cell.c] = room;
    f.lift[cell.c] = cell.head0 - (f.bed[cell.c] + room);
  }
  fill_ghosts(f, f.h, -1);
  return taken * f.cell * f.cell;
}

void ShallowFrame::place_bodies(double share) {
  for (std::size_t b = 0; b < s_.driven.size(); ++b) {
    s_.driven[b].place(share);
    s_.bodies[b].surface.positions = s_.driven[b].places;
  }
}

CellBox ShallowFrame::near_box(double dt, double top, double& speed) const {
  const Flow& f = s_.flow;
  CellBox out;
  speed = 0;
  const auto add = [&](const Box& box) {
    if (box.empty()) return;
    const auto cell = [&](double value, double origin, int count) {
      return static_cast<int>(std::floor(std::clamp((value - origin) / f.cell, -2.0, count + 2.0)));
    };
    const double x = setup_.origin.x(), z = setup_.origin.y();
    out.include({cell(box.lo.x(), x, f.nx), cell(box.lo.z(), z, f.nz), cell(box.hi.x(), x, f.nx) + 1,
                 cell(box.hi.z(), z, f.nz) + 1});
  };
  for (const DrivenNear& d : s_.driven) {
    double farthest = 0;
    add(d.box_below(top + f.cell, time_ / frame_time_, std::min(1.0, (time_ + dt) / frame_time_), farthest));
    speed = std::max(speed, farthest / frame_time_);
  }
  std::vector<Vec3> places;
  for (std::size_t b = 0; b < models_.size(); ++b) {
    const RigidMotion& m = s_.floats[b].motion;
    float_positions(models_[b], m.pose, places);
    Box box = bounds(places);
    const double fast = m.velocity.norm() + m.spin.norm() * 0.5 * box.size().norm() + setup_.gravity * dt;
    // In the air too: only a patch moves bodies.
    box.inflate(fast * dt);
    add(box);
    speed = std::max(speed, m.velocity.norm());
  }
  return out;
}

StepPlan ShallowFrame::plan() const {
  const Flow& f = s_.flow;
  const double left = frame_time_ - time_, fastest = *std::max_element(s_.speeds.begin(), s_.speeds.end());
  const double top = s_.bodies.empty() ? 0 : highest_water(f);
  const auto steps_of = [&](double dt) { return left / std::max(1.0, std::ceil(left / dt - 1e-9)); };
  const int across = speed_tiles(f.nx), along = speed_tiles(f.nz);
  StepPlan best;
  double best_cost = 1e300;
  double speed = std::max(fastest, 1e-9);
  for (int n = 0; n < k_candidates; ++n, speed *= 0.5) {
    double dt = steps_of(std::min(left, setup_.cfl * f.cell / speed));
    double body_speed = 0;
    CellBox box = near_box(dt, top, body_speed).inside(f.nx, f.nz, k_margin);
    const bool near = !box.empty();
    if (n > 0)
      for (int k = 0; k < along; ++k)
        for (int i = 0; i < across; ++i)
          if (s_.speeds[at(i) + at(across) * at(k)] * dt > setup_.cfl * f.cell * (1 + 1e-9))
            box.include(
                CellBox{i * k_speed_tile, k * k_speed_tile, (i + 1) * k_speed_tile, (k + 1) * k_speed_tile}.inside(
                    f.nx, f.nz, k_margin));
    box = aligned(box.inside(f.nx, f.nz, 0), f.nx, f.nz);
    // Fast water must not reach the rim in the step.
    const double reach = (k_margin - k_rim) * f.cell / (std::max(fastest, body_speed) + 1e-9);
    if (!box.empty() && box.size() < f.nx * f.nz && dt > reach) dt = steps_of(reach);
    const double inner_speed = box.empty() ? 0 : std::max(fastest_in(s_.speeds, across, box), body_speed);
    const double inner = std::ceil(dt * inner_speed / (setup_.cfl * f.cell));
    const bool alone = box.size() >= static_cast<double>(f.nx) * f.nz;
    const double cost = ((alone ? 0.0 : static_cast<double>(f.nx) * f.nz) +
                         inner * (k_patch_cost * box.size() + (near ? k_near_cost : 0.0))) /
                        dt;
    if (cost < best_cost) best_cost = cost, best = {dt, box};
    if (alone && n > 0) break;
  }
  return best;
}

void ShallowFrame::go() {
  flow_speeds(s_.flow, laws_, s_.speeds);
  while (frame_time_ - time_ > 1e-9 * frame_time_) {
    StepPlan p = plan();
    const std::vector<RigidPose> from = poses_of(s_.floats);
    while (!step(p)) ++report_.retries;
    time_ += p.dt;
    ++s_.step;
    ++report_.steps;
    if (s_.droplets.empty()) continue;
    met_.set_step((time_ - p.dt) / frame_time_, std::min(1.0, time_ / frame_time_), from, poses_of(s_.floats));
    fly(s_.droplets, {setup_.splash.air_density, setup_.splash.drag}, setup_.gravity, setup_.density, p.dt, met_);
    outflow_ += land(s_.droplets, s_.flow, setup_.origin.x(), setup_.origin.y(), setup_.level);
    fill_ghosts(s_.flow, s_.flow.h, -1);
    fill_ghosts(s_.flow, s_.flow.u, 0);
    fill_ghosts(s_.flow, s_.flow.w, 1);
  }
}

bool ShallowFrame::step(StepPlan& plan) {
  Flow& f = s_.flow;
  const bool alone = plan.box.size() >= static_cast<double>(f.nx) * f.nz;
  double out = 0;
  std::vector<double> speeds;
  if (plan.box.empty()) s_.near.clear();  // else what was near in an earlier step would be reported
  if (!alone) {
    step_velocities(f, laws_, plan.dt);
    step_depths(f, laws_, plan.dt, &speeds);
    out = Patch::outflow_beside(f, plan.box, plan.dt);
    if (!plan.box.empty()) s_.patch.rim(f, plan.box, plan.dt);
    finish_step(f);
  }
  if (!plan.box.empty()) {
    // What has to be put back if the step was too long.
    const std::vector<FloatState> floats = s_.floats;
    const std::vector<Vec6> impulse = impulse_;
    const std::vector<Wrench> peak = peak_;
    const ShallowReport report = report_;
    const std::size_t droplets = s_.droplets.size();
    const std::uint64_t id = s_.next_id;
    double elapsed = 0;
    patch_outflow_ = 0;
    if (!step_patch(plan, alone, elapsed)) {
      f.h.swap(f.h1), f.u.swap(f.u1), f.w.swap(f.w1), f.qx.swap(f.qx1), f.qz.swap(f.qz1);
      s_.floats = floats, impulse_ = impulse, peak_ = peak, report_ = report;
      s_.droplets.resize(droplets);
      s_.next_id = id;
      plan.dt = elapsed;
      return false;
    }
    s_.patch.end(f);
    out += patch_outflow_;
    if (alone) speeds.assign(s_.speeds.size(), 0.0);
    const int across = speed_tiles(f.nx), inner = speed_tiles(s_.patch.flow.nx);
    for (int k = 0; k < speed_tiles(s_.patch.flow.nz); ++k)
      for (int i = 0; i < inner; ++i)
        speeds[at(plan.box.i0 / k_speed_tile + i) + at(across) * at(plan.box.k0 / k_speed_tile + k)] =
            s_.patch_speeds[at(i) + at(inner) * at(k)];
  }
  s_.speeds = std::move(speeds);
  report_.fastest = std::max(report_.fastest, *std::max_element(s_.speeds.begin(), s_.speeds.end()));
  outflow_ += out;
  return true;
}

bool ShallowFrame::step_patch(const StepPlan& plan, bool alone, double& elapsed) {
  Flow& f = s_.flow;
  Patch& patch = s_.patch;
  patch.begin(f, plan.box, alone);
  Flow& p = patch.flow;
  const double x = setup_.origin.x() + f.cell * plan.box.i0, z = setup_.origin.y() + f.cell * plan.box.k0;
  double body_speed = 0, deepest = 0;
  for (int k = 0; k < p.nz; ++k)
    for (int i = 0; i < p.nx; ++i) deepest = std::max(deepest, p.h[p.of(i, k)]);
  near_box(plan.dt, highest_water(p), body_speed);
  const double wave = k_wave_share * std::sqrt(setup_.gravity * deepest);
  double speed = fastest_in(s_.speeds, speed_tiles(f.nx), plan.box);
  elapsed = 0;
  std::uint64_t number = 0;
  while (plan.dt - elapsed > 1e-9 * plan.dt) {
    const double left = plan.dt - elapsed;
    const double wanted = setup_.cfl * p.cell / std::max({speed, body_speed > 0 ? body_speed + wave : 0.0, 1e-9});
    const double dt = left / std::max(1.0, std::ceil(left / wanted - 1e-9));
    const double share = (elapsed + dt) / plan.dt;
    step_velocities(p, laws_, dt);
    patch.hold_rim(f, share);
    s_.near.clear();
    if (!s_.bodies.empty()) step_bodies(dt, std::min(1.0, (time_ + elapsed + dt) / frame_time_));
    patch.keep_owed(dt, left);
    speed = step_depths(p, laws_, dt, &s_.patch_speeds);
    patch_outflow_ += step_outflow(p, dt);
    if (!s_.near.cells().empty()) {
      add_forces(dt);
      if (setup_.splash.on) {
        const std::size_t before = s_.droplets.size();
        throw_droplets(p, s_.near, setup_.splash, {setup_.seed, number_, s_.step * 65536 + number}, x, z,
                       std::sqrt(2 * setup_.contact_pressure / setup_.density), dt, at(setup_.splash.most_droplets),
                       s_.next_id, s_.droplets);
        for (std::size_t n = before; n < s_.droplets.size(); ++n) report_.volume_thrown += s_.droplets[n].volume;
        report_.droplets_thrown += static_cast<int>(s_.droplets.size() - before);
      }
    }
    double lowest = 0;
    for (int k = 0; k < p.nz; ++k)
      for (int i = 0; i < p.nx; ++i) {
        lowest = std::min(lowest, p.h1[p.of(i, k)]);
        p.lift[p.of(i, k)] = 0;
      }
    report_.lowest_depth = std::min(report_.lowest_depth, lowest);
    finish_step(p);
    if (!alone) patch.set_ghosts(f, share);
    s_.near.keep_heads(p);
    ++report_.patch_steps;
    ++number;
    const bool last = left - dt <= 1e-9 * plan.dt;
    if (!alone && !last && patch.rim_speed(setup_.gravity, k_rim) * plan.dt > k_rim_cfl * p.cell) {
      elapsed = std::max(elapsed, dt);
      return false;
    }
    elapsed += dt;
  }
  return true;
}

}  // namespace ft::inline solvers
