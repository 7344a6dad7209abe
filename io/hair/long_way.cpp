// The first eigenfunction of the surface's Laplacian that is not constant. On a strip or tube of length L it is
// cos(pi s / L), whatever its width does, however it is bent or meshed, and no ends have to be known: they are where it
// is largest and smallest. Cotangent weights (Pinkall and Polthier 1993, "Computing discrete minimal surfaces and their
// conjugates"), lumped areas, inverse iteration. Departs from the paper: weights below a small positive one are raised
// to it, so that no vertex but the ends is an extremum.
#include "io/hair/long_way.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include "baker/core/mesh.h"

namespace ft::inline io {
namespace {

constexpr double k_least_weight = 1e-3;  ///< of an edge; 1 is that of an edge between two right-angled triangles
constexpr int k_most_turns = 60;

struct Graph {
  std::vector<Edge> edges;
  Adjacency neighbours;
};

/// Distances along edges from a vertex [m] (Dijkstra 1959).
std::vector<double> distances_from(int start, std::span<const Vec3> x, const Graph& graph) {
  std::vector<double> out(x.size(), std::numeric_limits<double>::infinity());
  using Item = std::pair<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> next;
  out[at(start)] = 0;
  next.push({0, start});
  while (!next.empty()) {
    const auto [distance, v] = next.top();
    next.pop();
    if (distance > out[at(v)]) continue;
    for (const int w : graph.neighbours.row(v)) {
      const double d = distance + (x[at(w)] - x[at(v)]).norm();
      if (d < out[at(w)]) next.push({out[at(w)] = d, w});
    }
  }
  return out;
}

int farthest(std::span<const double> distances) {
  return static_cast<int>(std::max_element(distances.begin(), distances.end()) - distances.begin());
}

double cotangent(const Vec3& a, const Vec3& b) {
  const double area = a.cross(b).norm();
  return area > 1e-12 * (a.squaredNorm() + b.squaredNorm()) ? a.dot(b) / area : 0;
}

struct Operators {
  Eigen::SparseMatrix<double> stiffness;
  Eigen::VectorXd mass;  ///< m2
};

Operators operators_of(std::span<const Vec3> x, std::span<const Triangle> triangles, const Graph& graph) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Operators out{Eigen::SparseMatrix<double>(n, n), Eigen::VectorXd::Zero(n)};
  std::vector<double> weights(graph.edges.size(), 0.0);
  double area = 0;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      const Edge edge{std::min(a, b), std::max(a, b)};
      const auto place = std::lower_bound(graph.edges.begin(), graph.edges.end(), edge) - graph.edges.begin();
      weights[static_cast<std::size_t>(place)] += 0.5 * cotangent(x[at(a)] - x[at(c)], x[at(b)] - x[at(c)]);
      const double third = triangle_area(x[at(a)], x[at(b)], x[at(c)]) / 3;
      out.mass[a] += third, area += third;
    }
  out.mass.array() += 1e-6 * area / static_cast<double>(n);  // none without
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t e = 0; e < weights.size(); ++e) {
    const auto [a, b] = graph.edges[e];
    const double w = std::clamp(weights[e], k_least_weight, 1 / k_least_weight);
    for (const auto& [i, j, value] : {std::tuple{a, a, w}, {b, b, w}, {a, b, -w}, {b, a, -w}})
      entries.emplace_back(i, j, value);
  }
  out.stiffness.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace

std::vector<double> long_way(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  if (positions.size() < 3) return {};
  Graph graph{unique_edges(triangles), {}};
  graph.neighbours = vertex_neighbours(positions.size(), graph.edges);
  const int one_end = farthest(distances_from(0, positions, graph));
  const std::vector<double> from_one = distances_from(one_end, positions, graph);
  const int other_end = farthest(from_one);
  const std::vector<double> from_other = distances_from(other_end, positions, graph);
  const double length = from_one[at(other_end)];
  if (!(length > 0) || !std::isfinite(length)) return {};

  double area = 0;
  for (const Triangle& t : triangles)
    area += triangle_area(positions[at(t[0])], positions[at(t[1])], positions[at(t[2])]);
  if (!(area > 1e-14 * length * length)) return {};

  const Operators op = operators_of(positions, triangles, graph);
  Eigen::SparseMatrix<double> shifted = op.stiffness;
  shifted.diagonal() += 0.1 / (length * length) * op.mass;  // far below the eigenvalue (pi / length)^2
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(shifted);
  if (solver.info() != Eigen::Success) return {};
  Eigen::VectorXd u(op.mass.size());
  for (Eigen::Index i = 0; i < u.size(); ++i)
    u[i] = from_one[static_cast<std::size_t>(i)] - from_other[static_cast<std::size_t>(i)];
  for (int turn = 0; turn < k_most_turns; ++turn) {
    Eigen::VectorXd next = solver.solve(op.mass.cwiseProduct(u));
    next.array() -= next.dot(op.mass) / op.mass.sum();
    const double size = next.cwiseAbs().maxCoeff();
    if (!(size > 0) || !std::isfinite(size)) return {};
    next /= size;
    const double change = (next - u).cwiseAbs().maxCoeff();
    u = next;
    if (change < 1e-9) break;
  }
  const double lo = u.minCoeff(), hi = u.maxCoeff();
  std::vector<double> out;
  for (const double value : u)  // of cos(pi s / L) the s
    out.push_back(std::acos(std::clamp(1 - 2 * (value - lo) / (hi - lo), -1.0, 1.0)) / std::numbers::pi);
  return out;
}

}  // namespace ft::inline io
