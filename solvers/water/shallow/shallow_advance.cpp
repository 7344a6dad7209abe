// A frame of shallow water, see shallow_solver.h. The top function reads like the summary.
#include <algorithm>
#include <cmath>

#include "solvers/water/shallow/shallow_frame.h"

namespace ft::inline solvers {
namespace {

/// Driven triangles that stay so far above the highest water are left out [m].
constexpr double k_above = 0.25;

}  // namespace

ShallowReport ShallowSolver::advance_frame(State& state, double frame_time, std::span<const DrivenBody> driven) {
  CHECK(frame_time > 0);
  ShallowScratch& s = *scratch_;
  Flow& f = s.flow;
  if (f.nx != model_.nx || f.nz != model_.nz) f = model_;
  f.h.swap(state.block("depth"));
  f.u.swap(state.block("u"));
  f.w.swap(state.block("w"));
  f.qx.swap(state.block("qx"));
  f.qz.swap(state.block("qz"));
  f.lift.swap(state.block("lift"));
  std::vector<double> account = state.block("account");
  s.droplets = read_droplets(state.block("droplets"));
  s.next_id = static_cast<std::uint64_t>(account[1]);
  const auto& floats = state.block("floats");
  s.floats.clear();
  for (std::size_t b = 0; b < floats_.size(); ++b)
    s.floats.push_back(read_float(std::span(floats).subspan(b * k_float_numbers, k_float_numbers)));
  s.driven.clear();
  const double top = highest_water(f);
  for (const DrivenBody& d : driven) s.driven.emplace_back(d, top + k_above);

  ShallowFrame frame(setup_, floats_, s, driven, frame_time, static_cast<std::uint64_t>(account[2]));
  if (account[3] == 0) account[0] += frame.make_room();
  frame.go();

  ShallowReport report = frame.report();
  account[0] += frame.outflow();
  account[1] = static_cast<double>(s.next_id);
  account[2] += 1;
  account[3] = 1;
  auto& wet = state.block("wet");
  const double dried = std::exp(-frame_time / setup_.drying_time);
  for (int k = 0; k < f.nz; ++k)
    for (int i = 0; i < f.nx; ++i) {
      double& w = wet[at(i) + at(f.nx) * at(k)];
      w = f.h[f.of(i, k)] > k_wet_depth ? 1 : w * dried;
    }
  f.h.swap(state.block("depth"));
  f.u.swap(state.block("u"));
  f.w.swap(state.block("w"));
  f.qx.swap(state.block("qx"));
  f.qz.swap(state.block("qz"));
  f.lift.swap(state.block("lift"));
  auto& bodies = state.block("floats");
  for (std::size_t b = 0; b < floats_.size(); ++b)
    write_float(s.floats[b], std::span(bodies).subspan(b * k_float_numbers, k_float_numbers));
  state.set("droplets", write_droplets(s.droplets));
  state.set("account", account);
  state.frame += 1;
  state.time += frame_time;
  report.ledger = ledger(state);
  return report;
}

}  // namespace ft::inline solvers
