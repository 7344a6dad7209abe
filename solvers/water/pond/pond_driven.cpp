// See pond_solver.h: skins that go through the water in a frame, and what splashes at its end.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/volume.h"
#include "solvers/water/pond/pond_frame.h"

namespace ft::inline solvers {
namespace {

constexpr int k_most_slices = 12;
constexpr double k_slice_way = 0.08;     ///< a skin goes so far in a slice, or a cell [m]
constexpr double k_near_surface = 0.25;  ///< vertices this near to it tell how fast a skin crosses it [m]
/// Of an impact's speed: what its droplets have; of slender ones (a diver), of round ones (a ball).
constexpr double k_slow = 0.25, k_fast = 0.6, k_round_slow = 0.4, k_round_fast = 0.9;

/// At a share of the frame, pool coordinates.
std::vector<Vec3> skin_at(const DrivenBody& body, const Vec3& corner, double share) {
  std::vector<Vec3> out(body.from.size());
  for (std::size_t v = 0; v < out.size(); ++v) out[v] = (1 - share) * body.from[v] + share * body.to[v] - corner;
  return out;
}

double ray_spacing(const PondModes& modes, std::span<const Vec3> positions) {
  const Vec3 size = bounds(positions).size();
  const double cell = std::min(modes.cell_x(), modes.cell_z());
  return std::clamp(std::max(size.x(), size.z()) / 40, std::max(0.2 * cell, 0.004), cell);
}

/// Of the skin where it crosses the surface, downwards [m/s].
double crossing_speed(std::span<const Vec3> at_start, std::span<const Vec3> velocities, const SkinUnderWater& from,
                      const SkinUnderWater& to, double time) {
  if (from.section == 0) return (from.bottom - to.bottom) / time;
  double sum = 0;
  int count = 0;
  for (std::size_t v = 0; v < at_start.size(); ++v)
    if (std::abs(at_start[v].y()) < k_near_surface) sum -= velocities[v].y(), ++count;
  return count > 0 ? sum / count : (from.bottom - to.bottom) / time;
}

}  // namespace

int PondSolver::begin_driven(Frame& f, std::span<const DrivenBody> driven, double frame_time) const {
  f.memory.crossings.resize(driven.size());
  f.skins.resize(driven.size());
  double most = 0;
  for (std::size_t b = 0; b < driven.size(); ++b) {
    CHECK(driven[b].from.size() == driven[b].to.size());
    SkinPoints& s = f.skins[b];
    s.places = skin_at(driven[b], setup_.corner, 0);
    s.velocities.resize(s.places.size());
    for (std::size_t v = 0; v < s.places.size(); ++v) {
      s.velocities[v] = (driven[b].to[v] - driven[b].from[v]) / frame_time;
      s.box.include(s.places[v]);
      s.box.include(s.places[v] + frame_time * s.velocities[v]);
      if (std::min(s.places[v].y(), s.places[v].y() + frame_time * s.velocities[v].y()) < k_near_surface)
        most = std::max(most, frame_time * s.velocities[v].norm());
    }
    f.report.driven[b].speed =
        (volume_centre(driven[b].to, driven[b].triangles) - volume_centre(driven[b].from, driven[b].triangles)).norm() /
        frame_time;
  }
  const double way = std::max(k_slice_way, std::max(modes_.cell_x(), modes_.cell_z()));
  return std::clamp(static_cast<int>(std::ceil(most / way)), 1, k_most_slices);
}

void PondSolver::cross_driven(Frame& f, std::span<const DrivenBody> driven, double frame_time, int slice,
                              int slices) const {
  const double time = frame_time / slices;
  for (std::size_t b = 0; b < driven.size(); ++b) {
    const SkinPoints& skin = f.skins[b];
    if (skin.box.lo.y() > k_near_surface) continue;
    const double from = static_cast<double>(slice) / slices, to = static_cast<double>(slice + 1) / slices;
    const std::vector<Vec3> start = skin_at(driven[b], setup_.corner, from),
                            end = skin_at(driven[b], setup_.corner, to);
    const double spacing = ray_spacing(modes_, start);
    const SkinUnderWater before = skin_under_water(start, driven[b].triangles, spacing);
    const SkinUnderWater after = skin_under_water(end, driven[b].triangles, spacing);
    for (const VolumePiece& p : before.pieces) f.layers.add(p.x, p.z, p.depth, -p.volume);
    for (const VolumePiece& p : after.pieces) f.layers.add(p.x, p.z, p.depth, p.volume);
    f.memory.account.driven += after.volume - before.volume;
    if (setup_.splash.on)
      cross_surface(before, after, crossing_speed(start, skin.velocities, before, after, time),
                    (before.top - after.top) / time, time, static_cast<double>(b), setup_.splash, setup_.density,
                    f.memory.crossings[b], f.memory.cavities);
    DrivenReport& r = f.report.driven[b];
    r.submerged = after.volume;
    const Wrench w = skin_force(skin_at(driven[b], setup_.corner, 0.5 * (from + to)), skin.velocities,
                                driven[b].triangles, modes_, f.heights, setup_.gravity, setup_.density)
                         .moved(-setup_.corner);
    r.mean += (1.0 / slices) * w;
    if (w.force.norm() > r.peak.force.norm()) r.peak = w;
  }
  close_cavities(time, setup_.gravity, setup_.density, setup_.splash, f.memory.crossings, f.memory.cavities, f.layers,
                 f.events, f.foam, modes_);
  f.memory.account.cavities += f.events.volume_change;
  f.events.volume_change = 0;
  f.feed.clear();
  if (f.layers.empty()) return;
  f.feed.assign(modes_.size(), 0.0);
  f.layers.pour(f.feed);
}

void PondSolver::throw_and_land(Frame& f, std::span<const DrivenBody> driven, std::vector<RigidPose> floats_from,
                                double frame_time) const {
  const double faded = std::exp(-frame_time / setup_.splash.foam_life);
  for (double& x : f.foam) x *= faded;
  const SplashWater water{setup_.gravity, setup_.density, frame_time, setup_.seed, f.frame};
  VolumeLayers pushes(modes_, 1.5 * std::max(modes_.cell_x(), modes_.cell_z()));
  std::vector<const FloatingBody*> floating;
  for (const PondFloat& body : setup_.floats) floating.push_back(&body.body);
  PondMet met{DropletBodies(driven, std::move(floating), setup_.corner), std::move(floats_from),
              poses_of(f.memory.floats)};
  const Landed landed = fly(modes_, water, f.heights, met, f.memory.droplets, f.layers, pushes, f.foam);
  f.report.landed = landed.count;
  f.memory.account.outflow += landed.gone;
  const std::size_t before = f.memory.droplets.size();
  ThrownWays ways;
  const auto give = [&](Throw t, std::uint64_t source) {
    t.source = source;
    if (throw_water(t, setup_.splash, water, f.heights, modes_, f.memory.droplets, f.memory.account.next_droplet, ways,
                    f.layers) > 0)
      f.memory.account.thrown += t.energy;
  };
  Floats& floats = f.memory.floats;
  for (std::size_t i = 0; i < floats_.size(); ++i) {
    const RigidMotion& m = floats.motion[i];
    const double size = std::cbrt(floats_[i].shape.volume * 3 / (4 * std::numbers::pi)), speed = floats.splash_speed[i];
    if (setup_.splash.on && speed > setup_.splash.slowest)
      give({.x = m.pose.position.x(),
            .z = m.pose.position.z(),
            .radius = size,
            .slow = k_round_slow * speed,
            .fast = k_round_fast * speed,
            .energy = setup_.splash.energy_share * floats.splash_energy[i]},
           i);
    floats.splash_energy[i] = floats.splash_speed[i] = 0;
  }
  for (std::size_t b = 0; b < f.memory.crossings.size(); ++b) {
    Crossing& c = f.memory.crossings[b];
    if (c.crown_energy > 0)
      give({.x = c.crown_x,
            .z = c.crown_z,
            .radius = 1.1 * c.crown_radius,
            .slow = k_slow * c.crown_speed,
            .fast = k_fast * c.crown_speed,
            .energy = setup_.splash.energy_share * c.crown_energy},
           1000000 + b);
    c.crown_energy = c.crown_speed = c.crown_radius = 0;
  }
  for (std::size_t j = 0; j < f.events.jets.size(); ++j) give(f.events.jets[j], 2000000 + j);
  met.set_step(0, 1);
  met.bodies.stop(std::span(f.memory.droplets).subspan(before), ways.starts, frame_time, ways.since);
  f.report.thrown = static_cast<int>(f.memory.droplets.size() - before);
  f.layers.pour(f.eta);
  pushes.pour(f.potential);
}

}  // namespace ft::inline solvers
