#include "solvers/linear/interpolation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "baker/core/check.h"

namespace ft::inline solvers {
namespace {

constexpr int k_max_candidates = 10;

/// Greedy independent set: taken breadth first so that its members sit in an even net.
std::vector<int> independent_set(const BlockPattern& p) {
  const int n = p.vertex_count();
  std::vector<char> state(at(n), 0);  // 0 open, 1 coarse, 2 covered
  std::vector<int> queue, coarse;
  std::vector<char> queued(at(n), 0);
  for (int seed = 0; seed < n; ++seed) {
    if (queued[at(seed)]) continue;
    queue.assign(1, seed);
    queued[at(seed)] = 1;
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const int v = queue[head];
      if (state[at(v)] == 0) {
        state[at(v)] = 1;
        coarse.push_back(v);
      }
      p.visit_row(v, [&](int u, int) {
        if (state[at(v)] == 1 && u != v) state[at(u)] = 2;
        if (!queued[at(u)]) queued[at(u)] = 1, queue.push_back(u);
      });
    }
  }
  std::sort(coarse.begin(), coarse.end());
  return coarse;
}

struct Choice {
  std::array<int, 3> coarse{-1, -1, -1};
  std::array<double, 3> weight{0, 0, 0};
  double cost = std::numeric_limits<double>::infinity();
};

void consider(Choice& best, std::span<const int> nodes, std::span<const double> weights, std::span<const Vec3> rest,
              const Vec3& x, std::span<const int> coarse_of) {
  Vec3 point = Vec3::Zero();
  double spread = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    point += weights[i] * rest[at(nodes[i])];
    spread += weights[i] * (rest[at(nodes[i])] - x).squaredNorm();
  }
  // What is not reproduced weighs more than how far the supports are.
  const double cost = 8 * (point - x).squaredNorm() + spread;
  if (!(cost < best.cost)) return;
  best.cost = cost;
  best.coarse = {-1, -1, -1};
  best.weight = {0, 0, 0};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    best.coarse[i] = coarse_of[at(nodes[i])];
    best.weight[i] = weights[i];
  }
}

Choice best_supports(const Vec3& x, std::span<const int> nodes, std::span<const Vec3> rest,
                     std::span<const int> coarse_of) {
  Choice best;
  const std::size_t n = nodes.size();
  for (std::size_t a = 0; a < n; ++a) {
    const Vec3& pa = rest[at(nodes[a])];
    consider(best, std::array{nodes[a]}, std::array{1.0}, rest, x, coarse_of);
    for (std::size_t b = a + 1; b < n; ++b) {
      const Vec3 ab = rest[at(nodes[b])] - pa;
      const double length2 = ab.squaredNorm();
      if (!(length2 > 0)) continue;
      const double t = std::clamp(ab.dot(x - pa) / length2, 0.0, 1.0);
      if (t > 0.02 && t < 0.98)
        consider(best, std::array{nodes[a], nodes[b]}, std::array{1 - t, t}, rest, x, coarse_of);
      for (std::size_t c = b + 1; c < n; ++c) {
        const Vec3 ac = rest[at(nodes[c])] - pa;
        const double d00 = length2, d01 = ab.dot(ac), d11 = ac.squaredNorm();
        const double area2 = d00 * d11 - d01 * d01;
        if (!(area2 > 1e-3 * d00 * d11)) continue;
        const double d20 = (x - pa).dot(ab), d21 = (x - pa).dot(ac);
        const double v = (d11 * d20 - d01 * d21) / area2, w = (d00 * d21 - d01 * d20) / area2;
        if (v < 0.02 || w < 0.02 || v + w > 0.98) continue;
        consider(best, std::array{nodes[a], nodes[b], nodes[c]}, std::array{1 - v - w, v, w}, rest, x, coarse_of);
      }
    }
  }
  return best;
}

Interpolation::Link link(int vertex, int share) {
  Interpolation::Link out;
  out.vertex = static_cast<std::uint32_t>(vertex) & (Interpolation::k_most_vertices - 1);
  out.share = static_cast<std::uint32_t>(share) & 63;
  return out;
}

/// Whole shares: rounded down, and what is missing goes to those that lost most.
Interpolation::Row in_shares(const Choice& choice) {
  std::array<int, 3> share;
  std::array<double, 3> lost;
  int missing = Interpolation::k_shares;
  for (std::size_t k = 0; k < 3; ++k) {
    const double exact = Interpolation::k_shares * choice.weight[k];
    share[k] = static_cast<int>(exact);
    lost[k] = exact - share[k];
    missing -= share[k];
  }
  for (; missing > 0; --missing) {
    const auto k = static_cast<std::size_t>(std::max_element(lost.begin(), lost.end()) - lost.begin());
    ++share[k];
    lost[k] -= 1;
  }
  Interpolation::Row row{};
  std::size_t next = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (share[k] != 0) row[next++] = link(choice.coarse[k], share[k]);
  return row;
}

void find_children(Interpolation& p) {
  p.children_start.assign(at(p.coarse_count()) + 1, 0);
  for (const Interpolation::Row& row : p.rows)
    for (const Interpolation::Link& to : row)
      if (to.share != 0) ++p.children_start[to.vertex + 1];
  std::partial_sum(p.children_start.begin(), p.children_start.end(), p.children_start.begin());
  p.children.resize(at(p.children_start.back()));
  std::vector<int> next = p.children_start;
  for (std::size_t v = 0; v < p.rows.size(); ++v)
    for (const Interpolation::Link& to : p.rows[v])
      if (to.share != 0) p.children[at(next[to.vertex]++)] = link(static_cast<int>(v), to.share);
}

}  // namespace

Interpolation make_interpolation(const BlockPattern& p, std::span<const Vec3> rest) {
  const int n = p.vertex_count();
  CHECK(n <= Interpolation::k_most_vertices);
  Interpolation result;
  result.coarse_to_fine = independent_set(p);
  std::vector<int> coarse_of(at(n), -1);
  for (int c = 0; c < result.coarse_count(); ++c) coarse_of[at(result.coarse_to_fine[at(c)])] = c;
  result.rows.resize(at(n));
  std::vector<int> stamp(at(n), -1), ring, nodes;
  for (int v = 0; v < n; ++v) {
    if (coarse_of[at(v)] >= 0) {
      result.rows[at(v)][0] = link(coarse_of[at(v)], Interpolation::k_shares);
      continue;
    }
    // Coarse vertices within two rings, nearest first.
    ring.assign(1, v);
    stamp[at(v)] = v;
    nodes.clear();
    std::size_t begin = 0;
    for (int depth = 0; depth < 2; ++depth) {
      const std::size_t end = ring.size();
      for (; begin < end; ++begin)
        p.visit_row(ring[begin], [&](int u, int) {
          if (stamp[at(u)] == v) return;
          stamp[at(u)] = v;
          ring.push_back(u);
          if (coarse_of[at(u)] >= 0) nodes.push_back(u);
        });
    }
    const Vec3& x = rest[at(v)];
    std::sort(nodes.begin(), nodes.end(), [&](int a, int b) {
      const double da = (rest[at(a)] - x).squaredNorm(), db = (rest[at(b)] - x).squaredNorm();
      return da != db ? da < db : a < b;
    });
    if (nodes.size() > k_max_candidates) nodes.resize(k_max_candidates);
    result.rows[at(v)] = in_shares(best_supports(x, nodes, rest, coarse_of));
  }
  find_children(result);
  return result;
}

}  // namespace ft::inline solvers
