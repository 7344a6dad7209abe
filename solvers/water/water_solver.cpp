#include "solvers/water/water_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "baker/core/check.h"
#include "baker/core/output_frame.h"
#include "baker/core/parallel.h"
#include "baker/core/volume.h"
#include "solvers/water/cavity_skin.h"

namespace ft::inline solvers {
namespace {

constexpr double k_below = 2e-3;         ///< the ground: where the mesh of dry cells lies [m]
constexpr double k_ledger_error = 1e-9;  ///< beyond it water got lost [1]

/// Of the grid's cells, and those around it, one to four.
struct Corner {
  int i, k;
  std::size_t vertex;
  std::array<std::size_t, 4> around{};
  std::size_t count = 0;
  std::span<const std::size_t> cells() const { return {around.data(), count}; }
};

template <class Visit>
void for_each_corner(const WaterGrid& grid, const Visit& visit) {
  parallel_for(at(grid.nz) + 1, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int i = 0; i <= grid.nx; ++i) {
        const int k = static_cast<int>(row);
        Corner corner{i, k, row * (at(grid.nx) + 1) + at(i)};
        for (const int z : {k - 1, k})
          for (const int x : {i - 1, i})
            if (x >= 0 && z >= 0 && x < grid.nx && z < grid.nz)
              corner.around[corner.count++] = at(z) * at(grid.nx) + at(x);
        visit(corner);
      }
  });
}

/// What is known of the surface goes with the vertices that are drawn in; walls of cavities have none of it.
template <class Value>
void put_drawn_in(const WaterGrid& grid, std::span<const DrawnIn> drawn, std::span<Value> values) {
  if (drawn.empty()) return;
  const std::vector<Value> level(values.begin(), values.end());
  for (const DrawnIn& v : drawn)
    values[v.vertex] =
        v.on_wall ? Value(0 * level[v.vertex]) : between_vertices<Value>(grid, level, v.place.x(), v.place.z());
}

}  // namespace

Mesh water_mesh(const std::string& name, const WaterGrid& grid, double level) {
  Mesh out;
  out.name = name;
  for (int k = 0; k <= grid.nz; ++k)
    for (int i = 0; i <= grid.nx; ++i) {
      out.positions.emplace_back(grid.origin.x() + grid.cell * i, level, grid.origin.y() + grid.cell * k);
      out.uvs.emplace_back(static_cast<double>(i) / grid.nx, static_cast<double>(k) / grid.nz);
    }
  const int row = grid.nx + 1;
  for (int k = 0; k < grid.nz; ++k)
    for (int i = 0; i < grid.nx; ++i) {
      const int first = row * k + i;
      out.face_sizes.push_back(4);
      for (const int v : {first, first + row, first + row + 1, first + 1}) {
        out.face_vertices.push_back(v);
        out.face_uvs.push_back(v);
      }
    }
  return out;
}

SystemShape droplets_shape(const std::string& name) {
  SystemShape out;
  out.name = name;
  out.content = {.shape = OutputShape::k_points, .changes = true, .velocities = true, .widths = true};
  return out;
}

WaterSolver::WaterSolver(WaterScene scene, std::unique_ptr<WaterCore> core)
    : scene_(std::move(scene)), core_(std::move(core)) {
  CHECK(core_->float_count() == static_cast<int>(scene_.floats.size()));
  mesh_ = water_mesh(scene_.name, core_->grid(), 0);
  droplets_ = droplets_shape(scene_.name + "_droplets");
  const State start = initial_state();
  volume_ = core_->ledger(start).total();
  system_positions(start, 0, mesh_.positions);
}

State WaterSolver::initial_state() const {
  State state = core_->initial_state();
  state.frame = scene_.first_frame - scene_.preroll_frames;
  state.time = -scene_.preroll_frames / scene_.fps;
  return state;
}

std::vector<DrawnIn> WaterSolver::drawn_in(const State& state) const {
  const std::vector<WaterCavity> cavities = core_->cavities(state);
  if (cavities.empty()) return {};
  std::vector<Vec3> level(mesh_.positions.size());
  level_positions(state, level);
  std::vector<double> heights(level.size());
  std::ranges::transform(level, heights.begin(), [](const Vec3& p) { return p.y(); });
  return draw_in(core_->grid(), heights, cavities);
}

void WaterSolver::system_positions(const State& state, int, std::span<Vec3> positions) const {
  level_positions(state, positions);
  for (const DrawnIn& v : drawn_in(state)) positions[v.vertex] = v.place;
}

void WaterSolver::level_positions(const State& state, std::span<Vec3> positions) const {
  const WaterGrid grid = core_->grid();
  WaterSurface now;
  core_->surface(state, now);
  for_each_corner(grid, [&](const Corner& corner) {
    double wet = 0, count = 0, ground = std::numeric_limits<double>::infinity();
    for (const std::size_t c : corner.cells())
      if (now.wet[c] != 0)
        wet += now.height[c], ++count;
      else
        ground = std::min(ground, now.height[c]);
    positions[corner.vertex] = Vec3(grid.origin.x() + grid.cell * corner.i, count > 0 ? wet / count : ground - k_below,
                                    grid.origin.y() + grid.cell * corner.k);
  });
}

void WaterSolver::system_scalars(const State& state, int system, std::vector<std::vector<float>>& values) const {
  const std::size_t count = scalar_names(system).size();
  values.resize(count);
  const WaterGrid grid = core_->grid();
  std::vector<double> of_cells(grid.count());
  const std::vector<DrawnIn> drawn = drawn_in(state);
  for (std::size_t n = 0; n < count; ++n) {
    core_->scalar(state, n, of_cells);
    values[n].resize(mesh_.positions.size());
    for_each_corner(grid, [&](const Corner& corner) {
      double sum = 0;
      for (const std::size_t c : corner.cells()) sum += of_cells[c];
      values[n][corner.vertex] = static_cast<float>(sum / static_cast<double>(corner.count));
    });
    put_drawn_in(grid, drawn, std::span(values[n]));
  }
}

void WaterSolver::surface_flow(const State& state, int, std::span<Vec3> velocities) const {
  const WaterGrid grid = core_->grid();
  WaterSurface now;
  core_->surface(state, now);
  std::vector<Vec3> flow(grid.count());
  core_->surface_flow(state, flow);
  for_each_corner(grid, [&](const Corner& corner) {
    Vec3 sum = Vec3::Zero();
    double count = 0;
    // Heights on the four sides of the corner, means over wet cells.
    double west = 0, east = 0, north = 0, south = 0;
    int wests = 0, easts = 0, norths = 0, souths = 0;
    for (const std::size_t c : corner.cells()) {
      if (now.wet[c] == 0) continue;
      sum += flow[c], ++count;
      const bool is_west = static_cast<int>(c % at(grid.nx)) < corner.i;
      const bool is_north = static_cast<int>(c / at(grid.nx)) < corner.k;
      (is_west ? west : east) += now.height[c], ++(is_west ? wests : easts);
      (is_north ? north : south) += now.height[c], ++(is_north ? norths : souths);
    }
    Vec3 v = count > 0 ? Vec3(sum / count) : Vec3::Zero();
    v.y() = 0;
    if (wests > 0 && easts > 0) v.y() += v.x() * (east / easts - west / wests) / grid.cell;
    if (norths > 0 && souths > 0) v.y() += v.z() * (south / souths - north / norths) / grid.cell;
    velocities[corner.vertex] = v;
  });
  put_drawn_in(grid, drawn_in(state), velocities);
}

void WaterSolver::system_frame(const State& state, int system, FrameData& frame) const {
  CHECK(system == 1);
  frame = {};
  for (const Droplet& drop : core_->droplets(state)) {
    frame.ids.push_back(drop.id);
    frame.positions.push_back(drop.place.cast<float>());
    frame.velocities.push_back(drop.velocity.cast<float>());
    frame.widths.push_back(static_cast<float>(2 * std::cbrt(3 * drop.volume / (4 * std::numbers::pi))));
  }
}

bool WaterSolver::moves(std::string_view primary) const {
  return std::ranges::find(scene_.floats, primary, &WaterFloat::name) != scene_.floats.end();
}

void WaterSolver::moved_positions(const State& state, std::string_view primary, std::span<Vec3> positions) const {
  const auto found = std::ranges::find(scene_.floats, primary, &WaterFloat::name);
  CHECK(found != scene_.floats.end() && found->positions.size() == positions.size());
  const RigidPose pose = core_->floating(state)[at(static_cast<int>(found - scene_.floats.begin()))].pose;
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = pose * found->positions[i];
}

void WaterSolver::add_forces(const WaterReport& done, std::span<const std::vector<Vec3>> to,
                             FrameReport& report) const {
  for (std::size_t b = 0; b < scene_.visitors.size(); ++b) {
    InteractionForce& row = report.forces.emplace_back();
    row.system = scene_.name;
    row.primary = scene_.visitors[b].name;
    if (b >= done.forces.size() || !(done.forces[b].wet_share > 0)) continue;
    const WaterOnBody& force = done.forces[b];
    row.peak = force.peak;
    row.contact_share = force.wet_share;
    row.mean = force.mean.moved(volume_centre(to[b], scene_.visitors[b].trajectory->surface().triangles));
  }
}

void WaterSolver::say(std::string text, FrameReport& report) const {
  Incident& incident = report.incidents.emplace_back();
  incident.kind = Incident::Kind::k_unsettled;
  incident.frame = report.frame;
  incident.system = scene_.name;
  incident.place = mesh_.positions[mesh_.positions.size() / 2];
  incident.text = std::move(text);
}

FrameReport WaterSolver::advance_frame(State& state) {
  const auto clock = std::chrono::steady_clock::now();
  FrameReport report;
  report.frame = state.frame + 1;
  report.smallest_gap = std::numeric_limits<double>::infinity();  // not measured
  const double t0 = (state.frame - scene_.first_frame) / scene_.fps,
               t1 = (report.frame - scene_.first_frame) / scene_.fps;
  std::vector<std::vector<Vec3>> from, to;
  std::vector<DrivenBody> bodies;
  for (const WaterVisitor& visitor : scene_.visitors) {
    const auto vertices = at(visitor.trajectory->surface().vertex_count());
    visitor.trajectory->sample(t0, from.emplace_back(vertices));
    visitor.trajectory->sample(t1, to.emplace_back(vertices));
  }
  for (std::size_t b = 0; b < from.size(); ++b)
    bodies.push_back({scene_.visitors[b].trajectory->surface().triangles, from[b], to[b]});
  WaterReport done;
  if (state.frame >= scene_.first_frame) done = core_->advance(state, t1 - t0, bodies);
  state.frame = report.frame;
  state.time = t1;
  report.substeps = done.steps + done.local_steps;
  report.newton_iterations = done.iterations;
  report.finite = done.finite;
  report.kinetic_energy = done.kinetic;
  add_forces(done, to, report);
  if (report.frame > scene_.first_frame) {
    const double total = done.ledger.total();
    const double error = std::abs(total - volume_) / volume_;
    report.own["water_volume"] = total;
    report.own["water_error"] = error;
    if (!(error < k_ledger_error))
      say(fmt::format("the account of the water is off by {:.1g} of all of it", error), report);
    report.own["water_airborne"] = done.ledger.droplets + done.ledger.pending;
    report.own["water_outflow"] = done.ledger.outflow;
    report.own["water_energy"] = done.kinetic + done.potential;
    report.own["water_droplets"] = done.airborne;
    if (done.fastest) report.own["water_fastest"] = *done.fastest;
    report.own["water_steps"] = done.steps + done.local_steps;
  }
  if (done.unsettled > 0)
    say(fmt::format("the water did not settle beside bodies in {} of its steps", done.unsettled), report);
  if (done.dry)
    say("the water is pushed down to its ground, which a pond never leaves dry: this is more than it can be", report);
  report.profile.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return report;
}

}  // namespace ft::inline solvers
