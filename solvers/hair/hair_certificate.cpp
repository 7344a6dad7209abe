// See hair_solver.h: what a frame's end is like.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "baker/core/state_points.h"
#include "solvers/hair/hair_group.h"

namespace ft::inline solvers {
namespace {

constexpr double k_look = 0.03;            ///< how far inside is found [m]
constexpr double k_inside = 1e-6;          ///< of a vertex [m]
constexpr double k_segment_inside = 1e-4;  ///< of the middle of a segment [m]

struct Tally {
  int inside = 0, segments = 0;
  double deepest = 0, energy = 0;
  bool finite = true;
  Tally operator+(const Tally& b) const {
    return {inside + b.inside, segments + b.segments, std::max(deepest, b.deepest), energy + b.energy,
            finite && b.finite};
  }
};

}  // namespace

void HairSolver::certify(const State& state, FrameReport& report) const {
  const std::size_t n = at(n_), count = setup_.strands.size();
  const auto x = as_points(*state.find("x")), v = as_points(*state.find("v"));
  std::vector<double> off(count);
  std::vector<int> inside(count, 0);
  const Tally sum = parallel_sum(count, 16, Tally(), [&](std::size_t begin, std::size_t end) {
    Tally out;
    for (std::size_t s = begin; s < end; ++s) {
      double length = 0;
      for (std::size_t i = 1; i < n; ++i) {
        const std::size_t k = s * n + i;
        out.finite = out.finite && x[k].allFinite() && v[k].allFinite();
        if (i > 1) length += (x[k] - x[k - 1]).norm();
        out.energy += 0.5 * rods_[s / k_lanes].mass[i][static_cast<int>(s % k_lanes)] * v[k].squaredNorm();
      }
      off[s] = std::abs(length / lengths_[s] - 1);
      if (!out.finite) continue;
      const auto depth = [&](const Vec3& p) { return bodies_.depth(p, k_look); };
      for (std::size_t i = at(std::max(2, setup_.strands[s].held + 1)); i < n; ++i) {
        const std::size_t k = s * n + i;
        const double combed = std::max(0.0, -gaps_[k] + k_least_reach);
        const double deep = depth(x[k]);
        if (deep > (gaps_[k] > 0 ? 0.0 : combed) + k_inside) {
          ++out.inside;
          inside[s] = 1;
          out.deepest = std::max(out.deepest, deep);
        } else if (i > 2 && gaps_[k] > 0 && gaps_[k - 1] > 0 && segment_gaps_[k] > 0) {
          const double middle = depth(0.5 * (x[k] + x[k - 1]));
          if (!(middle > k_segment_inside)) continue;
          ++out.segments;
          inside[s] = 1;
          out.deepest = std::max(out.deepest, middle);
        }
      }
    }
    return out;
  });
  report.inside_body = sum.inside;
  report.crossings_body = report.crossings_drawn = sum.inside + sum.segments;
  report.deepest_drawn = sum.deepest;
  report.kinetic_energy = sum.energy;
  report.finite = sum.finite;
  std::vector<double> sorted = off;
  std::sort(sorted.begin(), sorted.end());
  report.strain_max = sorted.back();
  report.strain_p99 = sorted[at(static_cast<int>(0.99 * static_cast<double>(count - 1)))];
  for (const double o : off) report.strain_mean += o / static_cast<double>(count);
  if (sum.inside + sum.segments > 0) {
    Incident& incident = report.incidents.emplace_back();
    incident.kind = Incident::Kind::k_penetration;
    incident.frame = report.frame;
    incident.system = setup_.name;
    const auto first = static_cast<std::size_t>(std::find(inside.begin(), inside.end(), 1) - inside.begin());
    incident.vertex = static_cast<int>(first);
    incident.place = x[first * n + n - 1];
    incident.depth = sum.deepest;
    incident.text = fmt::format("{} vertices and {} segments of strands are inside a body", sum.inside, sum.segments);
  }
}

}  // namespace ft::inline solvers
