#include "solvers/cloth/model/carry_smooth.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"

namespace ft::inline solvers {
namespace {

/// How strongly, and within what share of a typical edge others come along [1]. Sheets with spots of short edges of
/// many sizes (dense_spots) tell stiffnesses from 2 to 16 apart no better than chance does, and a reach from 0.5 to 2.
constexpr double k_stiffness = 4, k_reach = 1;
/// What has a short edge is linked along edges up to so many times as long: the spokes of a spot whose rim is short
/// [1].
constexpr double k_linked = 4;
/// Edges that are shorter than this share of the typical one are taken to be as long [1].
constexpr double k_shortest = 1.0 / 64;
/// Conjugate gradients stop at this share of the residual at the start, after about 17 iterations there [1].
constexpr double k_tolerance = 1e-3;
constexpr int k_most_iterations = 200;

double dot(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

}  // namespace

CarrySmooth::CarrySmooth(std::span<const Vec3> rest, const RestEdges& edges, std::span<const double> typical_edge,
                         double short_edge, const VertexClusters& clusters) {
  CHECK(rest.size() == typical_edge.size());
  const auto up_to = [&](std::size_t k, double share) {
    return edges.lengths[k] <= share * typical_edge[at(edges.edges[k][0])];
  };
  const auto add_ends_of = [&](const std::vector<std::size_t>& added) {
    for (const std::size_t k : added) vertices_.insert(vertices_.end(), edges.edges[k].begin(), edges.edges[k].end());
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  };
  std::vector<std::size_t> short_ones, linked;
  for (std::size_t k = 0; k < edges.edges.size(); ++k)
    if (up_to(k, short_edge)) short_ones.push_back(k);
  if (short_ones.empty()) return;
  add_ends_of(short_ones);
  for (std::size_t k = 0; k < edges.edges.size(); ++k)
    if (up_to(k, k_linked * short_edge) && (number_of(edges.edges[k][0]) >= 0 || number_of(edges.edges[k][1]) >= 0))
      linked.push_back(k);
  add_ends_of(linked);
  for (const int v : vertices_) {
    place_.push_back(clusters.of(v) < 0 ? rest[at(v)] : clusters.mean(clusters.of(v), rest));
    reach_.push_back(k_reach * typical_edge[at(v)]);
  }
  diagonal_.assign(vertices_.size(), 1.0);
  std::vector<Edge> directed;
  for (const std::size_t k : linked) {
    const double share = std::max(edges.lengths[k] / typical_edge[at(edges.edges[k][0])], k_shortest);
    const Link link{number_of(edges.edges[k][0]), number_of(edges.edges[k][1]), k_stiffness / (share * share)};
    diagonal_[at(link.a)] += link.weight;
    diagonal_[at(link.b)] += link.weight;
    directed.push_back({link.a, link.b});
    directed.push_back({link.b, link.a});
    links_.push_back(link);
  }
  std::sort(directed.begin(), directed.end());
  start_.assign(vertices_.size() + 1, 0);
  for (const Edge& e : directed) {
    ++start_[at(e[0]) + 1];
    next_.push_back(e[1]);
  }
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
}

/// Among vertices_; -1: it is not linked.
int CarrySmooth::number_of(int vertex) const {
  const auto found = std::lower_bound(vertices_.begin(), vertices_.end(), vertex);
  return found == vertices_.end() || *found != vertex ? -1 : static_cast<int>(found - vertices_.begin());
}

std::span<const CarrySmooth::Share> CarrySmooth::along_with(int vertex, Walk& walk) const {
  walk.shares.clear();
  const int first = number_of(vertex);
  if (first < 0) return {};
  walk.seen.resize(vertices_.size(), 0);
  walk.reached.assign(1, first);
  walk.seen[at(first)] = 1;
  for (std::size_t k = 0; k < walk.reached.size(); ++k) {
    const auto i = at(walk.reached[k]);
    const double distance = (place_[i] - place_[at(first)]).norm();
    if (distance >= reach_[at(first)]) continue;
    walk.shares.push_back({vertices_[i], 1 - distance / reach_[at(first)]});
    for (int n = start_[i]; n < start_[i + 1]; ++n)
      if (char& seen = walk.seen[at(next_[at(n)])]; seen == 0) seen = 1, walk.reached.push_back(next_[at(n)]);
  }
  for (const int i : walk.reached) walk.seen[at(i)] = 0;
  return walk.shares;
}

void CarrySmooth::multiply(std::span<const Vec3> x, std::span<Vec3> out) const {
  std::copy(x.begin(), x.end(), out.begin());
  for (const Link& l : links_) {
    const Vec3 pull = l.weight * (x[at(l.a)] - x[at(l.b)]);
    out[at(l.a)] += pull;
    out[at(l.b)] -= pull;
  }
}

/// Conjugate gradients, preconditioned by the diagonal, from the carry as it is; few vertices have short edges.
void CarrySmooth::smooth(std::span<Vec3> carry) const {
  if (empty()) return;
  const std::size_t n = vertices_.size();
  std::vector<Vec3> x(n), r(n), z(n), p, q(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = carry[at(vertices_[i])];
  multiply(x, q);
  for (std::size_t i = 0; i < n; ++i) r[i] = x[i] - q[i];
  const auto precondition = [&] {
    for (std::size_t i = 0; i < n; ++i) z[i] = r[i] / diagonal_[i];
    return dot(r, z);
  };
  double rz = precondition();
  p = z;
  const double enough = k_tolerance * k_tolerance * rz;
  for (int iteration = 0; iteration < k_most_iterations && rz > enough; ++iteration) {
    multiply(p, q);
    const double step = rz / dot(p, q);
    for (std::size_t i = 0; i < n; ++i) x[i] += step * p[i], r[i] -= step * q[i];
    const double before = rz;
    rz = precondition();
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + rz / before * p[i];
  }
  for (std::size_t i = 0; i < n; ++i) carry[at(vertices_[i])] = x[i];
}

}  // namespace ft::inline solvers
