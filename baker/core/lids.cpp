#include "baker/core/lids.h"

#include <algorithm>
#include <numeric>

#include "baker/core/disjoint_sets.h"

namespace ft {
namespace {

struct HalfEdge {
  Edge edge;
  int along;  ///< 1: from the smaller number to the larger, -1: back
};

/// Edges with what is left of their directions, in order.
std::vector<HalfEdge> open_edges(std::span<const Triangle> triangles, std::span<const int> first, double& edge_count) {
  std::vector<HalfEdge> half, out;
  half.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = first[at(t[k])], b = first[at(t[(k + 1) % 3])];
      if (a != b) half.push_back({{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1});
    }
  std::sort(half.begin(), half.end(), [](const HalfEdge& a, const HalfEdge& b) { return a.edge < b.edge; });
  for (std::size_t begin = 0, end = 0; begin < half.size(); begin = end) {
    int along = 0;
    for (end = begin; end < half.size() && half[end].edge == half[begin].edge; ++end) along += half[end].along;
    edge_count += 1;
    if (along != 0) out.push_back({half[begin].edge, along});
  }
  return out;
}

}  // namespace

std::vector<int> first_in_place(std::span<const Vec3> x) {
  const auto before = [&](int a, int b) {
    const Vec3 &p = x[at(a)], &q = x[at(b)];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::vector<int> order(x.size()), out(x.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), before);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && x[at(order[k])] == x[at(order[k - 1])];
    out[at(order[k])] = same ? out[at(order[k - 1])] : order[k];
  }
  return out;
}

Lids close_rims(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  Lids out;
  for (const Triangle& t : triangles)
    out.surface_area += 0.5 * (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]).norm();
  const std::vector<HalfEdge> rim = open_edges(triangles, first_in_place(x), out.edges);
  out.open_edges = static_cast<double>(rim.size());
  DisjointSets rims(x.size());
  for (const HalfEdge& e : rim) rims.join(e.edge[0], e.edge[1]);
  std::vector<int> lid_of(x.size(), -1);  // at the root
  std::vector<double> length;
  for (const HalfEdge& e : rim) {
    int& lid = lid_of[at(rims.root(e.edge[0]))];
    if (lid < 0) lid = static_cast<int>(length.size()), out.middles.push_back(Vec3::Zero()), length.push_back(0);
    const Vec3 &a = x[at(e.edge[0])], &b = x[at(e.edge[1])];
    const double own = (a - b).norm();
    out.middles[at(lid)] += 0.5 * own * (a + b);
    length[at(lid)] += own;
  }
  for (std::size_t i = 0; i < length.size(); ++i) out.middles[i] /= length[i];
  for (const HalfEdge& e : rim) {
    const int lid = lid_of[at(rims.root(e.edge[0]))];
    const Vec3& middle = out.middles[at(lid)];
    const double area = 0.5 * (x[at(e.edge[0])] - middle).cross(x[at(e.edge[1])] - middle).norm();
    for (int n = std::abs(e.along); n > 0; --n) {
      const int a = e.along > 0 ? e.edge[1] : e.edge[0], b = e.along > 0 ? e.edge[0] : e.edge[1];
      out.triangles.push_back({a, b, static_cast<int>(x.size()) + lid});
      out.area += area;
    }
  }
  return out;
}

}  // namespace ft
