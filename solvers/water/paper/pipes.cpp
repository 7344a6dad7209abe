// See pipes.h.
#include "solvers/water/paper/pipes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_rows = 8;  ///< of a block
constexpr std::array<int, k_pipes> k_di{1, 0, 1, -1}, k_dk{0, 1, 1, 1};
constexpr std::array<double, k_pipes> k_length{1, 1, 1.4142135623730951, 1.4142135623730951};  ///< cells
/// A / (l H) of pipes along the axes, and across corners.
constexpr double k_straight = 2.0 / 3, k_corner = 1.0 / 6;
/// Pipes are closed where less stands above their sill [m].
constexpr double k_closed = 1e-7;
/// A film has no speed of its own [m].
constexpr double k_film = 1e-3;

}  // namespace

PipeWater::PipeWater(const PaperSetup& s)
    : nx(s.nx),
      nz(s.nz),
      cell(s.cell),
      origin_(s.origin),
      edges_(s.edges),
      gravity_(s.gravity),
      manning_(s.manning),
      viscosity_(s.viscosity) {
  const std::size_t count = at(nx) * at(nz);
  bed = s.bed.empty() ? std::vector<double>(count, 0.0) : s.bed;
  depth.resize(count);
  for (std::size_t c = 0; c < count; ++c) depth[c] = s.depth.empty() ? std::max(0.0, s.level - bed[c]) : s.depth[c];
  for (auto& q : carries) q.assign(count, 0.0);
  head.resize(count), rise.assign(count, 0.0), scale_.resize(count), outside_.resize(count);
  for (std::size_t c = 0; c < count; ++c) outside_[c] = head[c] = bed[c] + depth[c];
}

double PipeWater::deepest() const {
  return *std::max_element(depth.begin(), depth.end());
}

double PipeWater::highest() const {
  double out = -std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < depth.size(); ++c)
    if (depth[c] > 0) out = std::max(out, head[c]);
  return out;
}

void PipeWater::find_heads(UnderBodies& under) {
  for (std::size_t c = 0; c < depth.size(); ++c) head[c] = bed[c] + depth[c];
  const auto cells = under.cells();
  for (std::size_t n = 0; n < cells.size(); ++n)
    head[cells[n].c] = under.head_of(static_cast<int>(n), depth[cells[n].c]);
}

PipeWater::Pipe PipeWater::pipe(const UnderBodies& under, int i, int k, std::size_t way) const {
  Pipe out;
  const int i1 = i + k_di[way], k1 = k + k_dk[way];
  if (i1 < 0 || i1 >= nx || k1 >= nz) return out;
  const std::size_t a = of(i, k), b = of(i1, k1), up = head[a] >= head[b] ? a : b, down = up == a ? b : a;
  out.share = way < 2 ? k_straight : k_corner;
  // Along an edge the corners that would be beyond it lie upon this pipe, as in a mirror.
  if (way == 0) out.share += k_corner * ((k == 0 ? 1 : 0) + (k == nz - 1 ? 1 : 0));
  if (way == 1) out.share += k_corner * ((i == 0 ? 1 : 0) + (i == nx - 1 ? 1 : 0));
  // What is free of bodies and has water, above the higher ground.
  const double sill = std::max(bed[a], bed[b]);
  double top = bed[up] + depth[up];
  if (const int n = under.of(down); n >= 0)
    top = std::min(top, bed[down] + std::max(depth[down], under.holds(n, head[up], false)));
  out.depth = top - sill;
  out.drop = std::max(head[a], sill) - std::max(head[b], sill);
  return out;
}

double PipeWater::edge_flow(std::size_t side, std::size_t c) const {
  if (edges_[side] == PaperEdge::k_wall) return 0;
  return cell * std::sqrt(gravity_ * depth[c]) * (head[c] - outside_[c]);
}

double PipeWater::step(const UnderBodies& under, double dt) {
  const double area = cell * cell;
  const auto rows = [&](auto&& body) {
    parallel_for(at(nz), k_rows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        for (int i = 0; i < nx; ++i) body(i, static_cast<int>(k));
    });
  };
  rows([&](int i, int k) {
    const std::size_t c = of(i, k);
    for (std::size_t way = 0; way < k_pipes; ++way) {
      const Pipe p = pipe(under, i, k, way);
      double& q = carries[way][c];
      if (!(p.share > 0 && p.depth > k_closed)) {
        q = 0;
        continue;
      }
      q += dt * p.share * p.depth * gravity_ * p.drop;
      if (manning_ > 0 || viscosity_ > 0) {
        const double speed = std::abs(q) / (p.share * p.depth * k_length[way] * cell);
        q /= 1 + dt * (gravity_ * manning_ * manning_ * speed / std::cbrt(p.depth * p.depth * p.depth * p.depth) +
                       3 * viscosity_ / (p.depth * p.depth));
      }
    }
  });
  // Of the eight pipes of a cell: what leaves by each.
  const auto leaving = [&](int i, int k, auto&& add) {
    const std::size_t c = of(i, k);
    for (std::size_t way = 0; way < k_pipes; ++way) {
      add(carries[way][c]);
      const int from_i = i - k_di[way], from_k = k - k_dk[way];
      if (from_i >= 0 && from_i < nx && from_k >= 0) add(-carries[way][of(from_i, from_k)]);
    }
    if (i == 0) add(edge_flow(0, c));
    if (i == nx - 1) add(edge_flow(1, c));
    if (k == 0) add(edge_flow(2, c));
    if (k == nz - 1) add(edge_flow(3, c));
  };
  rows([&](int i, int k) {
    double out = 0;
    leaving(i, k, [&](double q) { out += std::max(0.0, q); });
    const std::size_t c = of(i, k);
    scale_[c] = out * dt > depth[c] * area ? depth[c] * area / (out * dt) : 1;
  });
  rows([&](int i, int k) {
    const std::size_t c = of(i, k);
    for (std::size_t way = 0; way < k_pipes; ++way) {
      double& q = carries[way][c];
      if (q > 0)
        q *= scale_[c];
      else if (q < 0)
        q *= scale_[of(i + k_di[way], k + k_dk[way])];
    }
  });
  // The edges' flows hang on depths, which change next.
  std::vector<double> lost(at(nz), 0.0);
  parallel_for(at(nz), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int i = 0; i < nx; ++i) {
        const int k = static_cast<int>(row);
        const std::size_t c = of(i, k);
        double out = 0, over = 0;
        for (std::size_t way = 0; way < k_pipes; ++way) {
          out += carries[way][c];
          const int from_i = i - k_di[way], from_k = k - k_dk[way];
          if (from_i >= 0 && from_i < nx && from_k >= 0) out -= carries[way][of(from_i, from_k)];
        }
        const auto edge = [&](std::size_t side) {
          const double q = edge_flow(side, c);
          over += q > 0 ? q * scale_[c] : q;
        };
        if (i == 0) edge(0);
        if (i == nx - 1) edge(1);
        if (k == 0) edge(2);
        if (k == nz - 1) edge(3);
        lost[row] += dt * over;
        rise[c] = -(out + over) / area;
      }
  });
  parallel_for(depth.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) depth[c] = std::max(0.0, depth[c] + dt * rise[c]);
  });
  double sum = 0;
  for (const double l : lost) sum += l;
  return sum;
}

Vec2 PipeWater::velocity(std::size_t c) const {
  if (!(depth[c] > k_film)) return Vec2::Zero();
  const int i = static_cast<int>(c % at(nx)), k = static_cast<int>(c / at(nx));
  Vec2 sum = Vec2::Zero();
  for (std::size_t way = 0; way < k_pipes; ++way) {
    const Vec2 along(k_di[way], k_dk[way]);
    sum += carries[way][c] * along;
    const int from_i = i - k_di[way], from_k = k - k_dk[way];
    if (from_i >= 0 && from_i < nx && from_k >= 0) sum += carries[way][of(from_i, from_k)] * along;
  }
  return sum / (2 * depth[c] * cell);
}

double PipeWater::energy(const UnderBodies& under, int i, int k, std::size_t way) const {
  const double q = carries[way][of(i, k)];
  if (q == 0) return 0;
  const Pipe p = pipe(under, i, k, way);
  return p.depth > k_film ? 0.5 * q * q / (p.share * p.depth) : 0;
}

double PipeWater::kinetic(const UnderBodies& under) const {
  double sum = 0;
  for (int k = 0; k < nz; ++k) {
    double row = 0;
    for (int i = 0; i < nx; ++i)
      for (std::size_t way = 0; way < k_pipes; ++way) row += energy(under, i, k, way);
    sum += row;
  }
  return sum;
}

double PipeWater::kinetic_of(const UnderBodies& under, std::size_t c) const {
  const int i = static_cast<int>(c % at(nx)), k = static_cast<int>(c / at(nx));
  double sum = 0;
  for (std::size_t way = 0; way < k_pipes; ++way) {
    sum += energy(under, i, k, way);
    const int from_i = i - k_di[way], from_k = k - k_dk[way];
    if (from_i >= 0 && from_i < nx && from_k >= 0) sum += energy(under, from_i, from_k, way);
  }
  return sum;
}

void PipeWater::slow(std::size_t c, double share) {
  const int i = static_cast<int>(c % at(nx)), k = static_cast<int>(c / at(nx));
  const double factor = std::sqrt(1 - share);
  for (std::size_t way = 0; way < k_pipes; ++way) {
    carries[way][c] *= factor;
    const int from_i = i - k_di[way], from_k = k - k_dk[way];
    if (from_i >= 0 && from_i < nx && from_k >= 0) carries[way][of(from_i, from_k)] *= factor;
  }
}

}  // namespace ft::inline solvers
