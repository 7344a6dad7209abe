// See shallow_solver.h: setting up, states and what is read from them. How a frame goes is in shallow_advance.cpp.
#include "solvers/water/shallow/shallow_solver.h"

#include <algorithm>
#include <cmath>

#include "solvers/water/shallow/shallow_scratch.h"

namespace ft::inline solvers {

Result<ShallowSolver> ShallowSolver::make(ShallowSetup setup) {
  if (Status status = check_shallow_setup(setup); !status) return status.error();
  return ShallowSolver(std::move(setup));
}

ShallowSolver::ShallowSolver(ShallowSolver&&) noexcept = default;
ShallowSolver& ShallowSolver::operator=(ShallowSolver&&) noexcept = default;
ShallowSolver::~ShallowSolver() = default;

ShallowSolver::ShallowSolver(ShallowSetup setup)
    : setup_(std::move(setup)),
      model_(setup_.nx, setup_.nz, setup_.cell),
      scratch_(std::make_unique<ShallowScratch>()) {
  for (std::size_t s = 0; s < 4; ++s)
    model_.sides[s] = setup_.edges[s] == ShallowEdge::k_open ? FlowSide::k_open : FlowSide::k_wall;
  for (int k = 0; k < setup_.nz; ++k)
    for (int i = 0; i < setup_.nx; ++i) {
      const std::size_t n = at(i) + at(setup_.nx) * at(k), c = model_.of(i, k);
      model_.bed[c] = setup_.bed.empty() ? 0 : setup_.bed[n];
      model_.h[c] = setup_.depth.empty() ? std::max(0.0, setup_.level - model_.bed[c]) : setup_.depth[n];
      model_.edge[c] = model_.bed[c] + model_.h[c];
    }
  fill_ghosts(model_, model_.bed, -1);
  find_face_beds(model_);
  fill_ghosts(model_, model_.h, -1);
  fill_ghosts(model_, model_.edge, -1);
  for (const ShallowFloat& f : setup_.floats) floats_.push_back(float_model(f.body));
}

State ShallowSolver::initial_state() const {
  State state;
  std::vector<double> h = model_.h, lift(h.size(), 0.0), floats;
  std::vector<std::vector<Vec3>> positions;
  std::vector<NearBody> bodies;
  for (std::size_t b = 0; b < floats_.size(); ++b) {
    FloatState f;
    f.motion = setup_.floats[b].start;
    f.motion.pose.rotation.normalize();
    floats.resize(floats.size() + k_float_numbers);
    write_float(f, std::span(floats).last(k_float_numbers));
    float_positions(floats_[b], f.motion.pose, positions.emplace_back());
  }
  for (std::size_t b = 0; b < floats_.size(); ++b)
    bodies.emplace_back().surface = {floats_[b].body.triangles, positions[b]};
  if (!bodies.empty()) {
    NearWater near;
    near.find(model_, bodies, setup_.origin.x(), setup_.origin.y(), near_laws(setup_));
    for (const NearWater::Cell& cell : near.cells()) {
      if (cell.begin == cell.end) continue;
      h[cell.c] = std::max(0.0, near.holds(model_, cell, cell.head0));
      lift[cell.c] = cell.head0 - (model_.bed[cell.c] + h[cell.c]);
    }
    fill_ghosts(model_, h, -1);
  }
  std::vector<double> wet(at(setup_.nx) * at(setup_.nz));
  for (int k = 0; k < setup_.nz; ++k)
    for (int i = 0; i < setup_.nx; ++i) wet[at(i) + at(setup_.nx) * at(k)] = h[model_.of(i, k)] > k_wet_depth ? 1 : 0;
  state.set("depth", std::move(h));
  for (const char* name : {"u", "w", "qx", "qz"}) state.set(name, std::vector<double>(model_.size()));
  state.set("lift", std::move(lift));
  state.set("wet", std::move(wet));
  state.set("floats", std::move(floats));
  state.set("droplets", {});
  state.set("account", {0, 1, 0, 0});
  return state;
}

namespace {

template <class T, class Of>
std::vector<T> of_cells(const Flow& model, Of&& of) {
  std::vector<T> out(at(model.nx) * at(model.nz));
  for (int k = 0; k < model.nz; ++k)
    for (int i = 0; i < model.nx; ++i) out[at(i) + at(model.nx) * at(k)] = of(model.of(i, k));
  return out;
}

}  // namespace

std::vector<double> ShallowSolver::depths(const State& state) const {
  const auto& h = *state.find("depth");
  return of_cells<double>(model_, [&](std::size_t c) { return h[c]; });
}

std::vector<double> ShallowSolver::surface(const State& state) const {
  const auto& h = *state.find("depth");
  return of_cells<double>(model_, [&](std::size_t c) { return model_.bed[c] + h[c]; });
}

std::vector<Vec2> ShallowSolver::velocities(const State& state) const {
  const auto &u = *state.find("u"), &w = *state.find("w");
  return of_cells<Vec2>(model_,
                        [&](std::size_t c) { return Vec2(0.5 * (u[c] + u[c + 1]), 0.5 * (w[c] + w[c + model_.row])); });
}

std::vector<double> ShallowSolver::wet(const State& state) const {
  return *state.find("wet");
}

std::vector<char> ShallowSolver::covered(const State& state) const {
  const auto& lift = *state.find("lift");
  return of_cells<char>(model_, [&](std::size_t c) { return static_cast<char>(lift[c] > 0 ? 1 : 0); });
}

std::vector<Droplet> ShallowSolver::droplets(const State& state) const {
  return read_droplets(*state.find("droplets"));
}

std::vector<RigidMotion> ShallowSolver::floats(const State& state) const {
  const auto& numbers = *state.find("floats");
  std::vector<RigidMotion> out;
  for (std::size_t b = 0; b < floats_.size(); ++b)
    out.push_back(read_float(std::span(numbers).subspan(b * k_float_numbers, k_float_numbers)).motion);
  return out;
}

WaterLedger ShallowSolver::ledger(const State& state) const {
  WaterLedger out;
  const auto &h = *state.find("depth"), &drops = *state.find("droplets");
  for (int k = 0; k < model_.nz; ++k) {
    double row = 0;
    for (int i = 0; i < model_.nx; ++i) row += h[model_.of(i, k)];
    out.columns += row;
  }
  out.columns *= setup_.cell * setup_.cell;
  for (std::size_t n = 0; n + k_droplet_numbers <= drops.size(); n += k_droplet_numbers) out.droplets += drops[n + 7];
  out.outflow = (*state.find("account"))[0];
  return out;
}

}  // namespace ft::inline solvers
