// See paper_solver.h.
#include "solvers/water/paper/paper_solver.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "solvers/water/paper/paper_frame.h"

namespace ft::inline solvers {
namespace {

constexpr std::array<const char*, k_pipes> k_blocks{"pipes_x", "pipes_z", "pipes_xz", "pipes_zx"};
/// Driven triangles that stay so far above the highest water are left out [m].
constexpr double k_above = 0.25;

}  // namespace

Result<PaperSolver> PaperSolver::make(PaperSetup setup) {
  if (Status status = check_paper_setup(setup); !status) return status.error();
  return PaperSolver(std::move(setup));
}

PaperSolver::PaperSolver(PaperSolver&&) noexcept = default;
PaperSolver& PaperSolver::operator=(PaperSolver&&) noexcept = default;
PaperSolver::~PaperSolver() = default;

PaperSolver::PaperSolver(PaperSetup setup) : setup_(std::move(setup)) {
  scratch_ = std::make_unique<PaperScratch>(setup_);
  for (const PlacedFloat& f : setup_.floats) floats_.push_back(float_model(f.body));
  const std::vector<double> depth = depths(initial_state());
  scratch_->water.depth = depth;
  PaperFrame frame(setup_, floats_, *scratch_, {}, 1, 0);
  frame.meet(0);
  still_ = frame.potential();
}

State PaperSolver::initial_state() const {
  State state;
  PaperScratch scratch(setup_);
  std::vector<double> floats(floats_.size() * k_float_numbers);
  for (std::size_t b = 0; b < floats_.size(); ++b) {
    FloatState& f = scratch.floats.emplace_back();
    f.motion = setup_.floats[b].start;
    f.motion.pose.rotation.normalize();
    write_float(f, std::span(floats).subspan(b * k_float_numbers, k_float_numbers));
  }
  scratch_->floats = scratch.floats;
  PipeWater& w = scratch.water;
  const std::vector<double> head = w.head;
  PaperFrame frame(setup_, floats_, scratch, {}, 1, 0);
  frame.meet(0);
  const auto cells = scratch.under.cells();
  for (std::size_t n = 0; n < cells.size(); ++n) {
    double& depth = w.depth[cells[n].c];
    if (depth > 0) depth = std::clamp(scratch.under.holds(static_cast<int>(n), head[cells[n].c], true), 0.0, depth);
  }
  frame.meet(0);
  state.set("tops", frame.tops());
  state.set("depth", std::move(w.depth));
  for (std::size_t way = 0; way < k_pipes; ++way) state.set(k_blocks[way], std::move(w.carries[way]));
  state.set("floats", std::move(floats));
  state.set("droplets", {});
  state.set("account", {0, 1, 0, 0});
  return state;
}

WaterReport PaperSolver::advance_frame(State& state, double frame_time, std::span<const DrivenBody> driven) {
  CHECK(frame_time > 0);
  PaperScratch& s = *scratch_;
  PipeWater& w = s.water;
  w.depth.swap(state.block("depth"));
  for (std::size_t way = 0; way < k_pipes; ++way) w.carries[way].swap(state.block(k_blocks[way]));
  std::vector<double> account = state.block("account");
  s.droplets = read_droplets(state.block("droplets"));
  s.next_id = static_cast<std::uint64_t>(account[1]);
  s.floats.clear();
  auto& floats = state.block("floats");
  for (std::size_t b = 0; b < floats_.size(); ++b)
    s.floats.push_back(read_float(std::span(floats).subspan(b * k_float_numbers, k_float_numbers)));
  s.driven.clear();
  for (std::size_t c = 0; c < w.depth.size(); ++c) w.head[c] = w.bed[c] + w.depth[c];
  const double top = w.highest() + k_above;
  for (const DrivenBody& d : driven) s.driven.emplace_back(d, top);

  PaperFrame frame(setup_, floats_, s, driven, frame_time, static_cast<std::uint64_t>(account[2]));
  if (account[3] == 0) account[0] += frame.make_room();
  frame.go();
  WaterReport report = frame.report();
  state.set("tops", frame.tops());
  report.potential -= setup_.density * setup_.gravity * still_;

  account[0] += frame.outflow();
  account[1] = static_cast<double>(s.next_id);
  account[2] += 1;
  account[3] = 1;
  w.depth.swap(state.block("depth"));
  for (std::size_t way = 0; way < k_pipes; ++way) w.carries[way].swap(state.block(k_blocks[way]));
  for (std::size_t b = 0; b < floats_.size(); ++b)
    write_float(s.floats[b], std::span(floats).subspan(b * k_float_numbers, k_float_numbers));
  state.set("droplets", write_droplets(s.droplets));
  state.set("account", account);
  state.frame += 1;
  state.time += frame_time;
  report.ledger = ledger(state);
  return report;
}

std::vector<double> PaperSolver::depths(const State& state) const {
  return *state.find("depth");
}

std::vector<double> PaperSolver::tops(const State& state) const {
  return *state.find("tops");
}

double PaperSolver::bed(std::size_t cell) const {
  return setup_.bed.empty() ? 0 : setup_.bed[cell];
}

std::vector<Vec2> PaperSolver::velocities(const State& state) const {
  PipeWater water(setup_);
  water.depth = *state.find("depth");
  for (std::size_t way = 0; way < k_pipes; ++way) water.carries[way] = *state.find(k_blocks[way]);
  std::vector<Vec2> out(water.depth.size());
  parallel_for(out.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) out[c] = water.velocity(c);
  });
  return out;
}

std::vector<Droplet> PaperSolver::droplets(const State& state) const {
  return read_droplets(*state.find("droplets"));
}

std::vector<RigidMotion> PaperSolver::floats(const State& state) const {
  const auto& numbers = *state.find("floats");
  std::vector<RigidMotion> out;
  for (std::size_t b = 0; b < floats_.size(); ++b)
    out.push_back(read_float(std::span(numbers).subspan(b * k_float_numbers, k_float_numbers)).motion);
  return out;
}

WaterLedger PaperSolver::ledger(const State& state) const {
  WaterLedger out;
  const auto& h = *state.find("depth");
  for (int k = 0; k < setup_.nz; ++k) {
    double row = 0;
    for (int i = 0; i < setup_.nx; ++i) row += h[at(i) + at(setup_.nx) * at(k)];
    out.columns += row;
  }
  out.columns *= setup_.cell * setup_.cell;
  for (const Droplet& d : droplets(state)) out.droplets += d.volume;
  out.outflow = (*state.find("account"))[0];
  return out;
}

}  // namespace ft::inline solvers
