// See paper_frame.h: how long steps are, and what one does. Bodies are pushed by the heads of a step's start, the pipes
// by the same; then both move (symplectic).
#include "solvers/water/paper/paper_frame.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

/// The stiffest pattern of columns, by g H/cell^2: pipes to all sides, neighbours across all edges opposed.
constexpr double k_stiffest = 16.0 / 3;
/// Cells that a body may go in a step [1].
constexpr double k_body_cfl = 0.25;
/// How much of the deepest water a step may add before the next one is measured [1].
constexpr double k_margin = 1.1;

}  // namespace

PaperFrame::PaperFrame(const PaperSetup& setup, std::span<const FloatingHull> hulls, PaperScratch& scratch,
                       std::span<const DrivenBody> driven, double frame_time, std::uint64_t number)
    : setup_(setup),
      hulls_(hulls),
      s_(scratch),
      met_(driven, bodies_of(hulls)),
      frame_time_(frame_time),
      number_(number) {
  on_driven_.resize(s_.driven.size());
  report_.finite = true;
  for (const DrivenNear& d : s_.driven)
    for (std::size_t v = 0; v < d.from.size(); ++v)
      body_speed_ = std::max(body_speed_, (d.to[v] - d.from[v]).norm() / frame_time);
}

void PaperFrame::meet(double share) {
  std::vector<BodySurface> surfaces;
  for (DrivenNear& d : s_.driven) {
    d.place(share);
    surfaces.push_back({d.triangles, d.places});
  }
  s_.places.resize(hulls_.size());
  for (std::size_t b = 0; b < hulls_.size(); ++b) {
    float_positions(hulls_[b], s_.floats[b].motion.pose, s_.places[b]);
    surfaces.push_back({hulls_[b].body.triangles, s_.places[b]});
  }
  s_.under.find(s_.water.met(), surfaces, s_.water.highest(), setup_.stiffness);
  s_.water.find_heads(s_.under);
}

double PaperFrame::make_room() {
  PipeWater& w = s_.water;
  // The heads without the driven ones, of which there are none yet.
  std::vector<DrivenNear> driven;
  driven.swap(s_.driven);
  meet(0);
  const std::vector<double> head = w.head;
  driven.swap(s_.driven);
  meet(0);
  double gone = 0;
  const auto cells = s_.under.cells();
  for (std::size_t n = 0; n < cells.size(); ++n) {
    double& depth = w.depth[cells[n].c];
    const double kept = std::clamp(s_.under.holds(static_cast<int>(n), head[cells[n].c], true), 0.0, depth);
    gone += depth - kept;
    depth = kept;
  }
  return gone * w.cell * w.cell;
}

double PaperFrame::step_time() const {
  const PipeWater& w = s_.water;
  const bool near = !s_.under.cells().empty();
  double rate =
      k_stiffest * setup_.gravity * k_margin * w.deepest() / (w.cell * w.cell) * (near ? setup_.stiffness : 1);
  double fastest = near ? body_speed_ : 0;
  for (std::size_t b = 0; b < hulls_.size(); ++b) {
    const RigidMotion& m = s_.floats[b].motion;
    fastest = std::max(fastest, m.velocity.norm());
    if (!s_.under.rectangle(s_.driven.size() + b).empty()) rate += float_rate(hulls_[b], setup_);
  }
  double out = rate > 0 ? setup_.cfl * std::sqrt(k_stiffest / rate) : frame_time_;
  if (fastest > 0) out = std::min(out, k_body_cfl * w.cell / fastest);
  return out;
}

void PaperFrame::go() {
  meet(0);
  std::uint64_t number = 0;
  while (frame_time_ - time_ > 1e-9 * frame_time_) {
    const double left = frame_time_ - time_;
    const double dt = left / std::max(1.0, std::ceil(left / step_time() - 1e-9));
    step(dt, number++);
    time_ += dt;
    meet(std::min(1.0, time_ / frame_time_));
    ++report_.steps;
    if (!std::isfinite(s_.water.depth.front())) break;
  }
}

void PaperFrame::step(double dt, std::uint64_t number) {
  PipeWater& w = s_.water;
  push_driven(dt);
  const std::vector<RigidPose> from = poses_of(s_.floats);
  move_floats(dt);
  if (!s_.droplets.empty()) {
    met_.set_step(time_ / frame_time_, std::min(1.0, (time_ + dt) / frame_time_), from, poses_of(s_.floats));
    fly(s_.droplets, setup_.splash.air, setup_.gravity, setup_.density, dt, met_);
    outflow_ += land(s_.droplets, w, setup_.origin, setup_.level);
  }
  outflow_ += w.step(s_.under, dt);
  if (setup_.splash.on)
    report_.thrown += throw_droplets(w, s_.under, setup_.splash, {setup_.seed, number_, number}, dt, setup_.origin,
                                     s_.next_id, s_.droplets);
}

std::vector<double> PaperFrame::tops() const {
  std::vector<double> out = s_.water.head;
  const auto cells = s_.under.cells();
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const std::size_t c = cells[n].c;
    if (s_.under.covered(static_cast<int>(n), out[c])) out[c] = s_.water.bed[c] + s_.water.depth[c];
  }
  return out;
}

double PaperFrame::potential() const {
  const PipeWater& w = s_.water;
  double sum = 0;
  for (int k = 0; k < w.nz; ++k) {
    double row = 0;
    for (int i = 0; i < w.nx; ++i) {
      const std::size_t c = w.of(i, k);
      const int n = s_.under.of(c);
      row += n < 0 ? w.depth[c] * (w.bed[c] + 0.5 * w.depth[c]) : s_.under.work(n, w.head[c]);
    }
    sum += row;
  }
  return sum * w.cell * w.cell;
}

WaterReport PaperFrame::report() const {
  const PipeWater& w = s_.water;
  WaterReport out = report_;
  out.airborne = static_cast<int>(s_.droplets.size());
  out.kinetic = setup_.density * w.kinetic(s_.under);
  out.potential = setup_.density * setup_.gravity * potential();
  double fastest = 0, sum = 0;
  for (std::size_t c = 0; c < w.depth.size(); ++c) {
    fastest = std::max(fastest, w.velocity(c).norm());
    sum += w.depth[c];
  }
  out.fastest = fastest;
  for (std::size_t b = 0; b < hulls_.size(); ++b) {
    const RigidMotion& m = s_.floats[b].motion;
    const RigidMass& mass = hulls_[b].body.mass;
    const Mat3 turn = m.pose.rotation.toRotationMatrix();
    out.kinetic += 0.5 * (mass.mass + s_.floats[b].added_mass) * m.velocity.squaredNorm() +
                   0.5 * m.spin.dot(turn * mass.inertia * turn.transpose() * m.spin);
    out.potential += mass.mass * setup_.gravity * m.pose.position.y();
  }
  for (const Droplet& d : s_.droplets) {
    out.kinetic += 0.5 * setup_.density * d.volume * d.velocity.squaredNorm();
    out.potential += setup_.density * setup_.gravity * d.volume * d.place.y();
  }
  out.finite = std::isfinite(sum) && std::isfinite(out.kinetic) && std::isfinite(out.potential);
  for (WaterOnBody on : on_driven_) {
    on.mean.force /= frame_time_, on.mean.torque /= frame_time_, on.wet_share /= frame_time_;
    out.forces.push_back(on);
  }
  return out;
}

}  // namespace ft::inline solvers
