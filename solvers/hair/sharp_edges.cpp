#include "solvers/hair/sharp_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ft::inline solvers {
namespace {

/// A segment that lies across a ridge with both ends on the body cuts less deep than this where the ridge is flat:
/// strands keep farther away [m].
constexpr double k_shallow = 5e-4;

struct Side {
  int low, high, triangle, k;
  auto key() const { return std::array{low, high, triangle, k}; }
};

Vec3 normal_of(std::span<const Vec3> x, const Triangle& t) {
  return (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]).normalized();
}

double height(std::span<const Vec3> x, const Triangle& t, const Side& side) {
  const Vec3 edge = x[at(side.high)] - x[at(side.low)];
  return edge.cross(x[at(t[at((side.k + 2) % 3)])] - x[at(side.low)]).norm() / edge.norm();
}

/// Of an edge of two triangles, whether its faces bend away from each other on the outside, and so much that a segment
/// cuts. Where triangles are small against it, it lies across more edges that bend alike.
bool is_ridge(std::span<const Vec3> x, std::span<const Triangle> triangles, double length, const Side& a,
              const Side& b) {
  const Triangle &first = triangles[at(a.triangle)], &second = triangles[at(b.triangle)];
  const Vec3 n = normal_of(x, first), m = normal_of(x, second);
  const double turn = std::acos(std::clamp(n.dot(m), -1.0, 1.0));
  const double h = 0.5 * (height(x, first, a) + height(x, second, b));
  if (turn * length / 8 * std::max(1.0, length / h) < k_shallow) return false;
  const Vec3& across = x[at(second[at((b.k + 2) % 3)])];
  return n.dot(across - x[at(a.low)]) < 0;
}

}  // namespace

SharpEdges::SharpEdges(std::span<const Vec3> bind, std::span<const Triangle> triangles, double length, bool all)
    : sharp_(triangles.size(), 0) {
  std::vector<Side> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][at(k)], triangles[t][at((k + 1) % 3)]);
      sides.push_back({low, high, static_cast<int>(t), k});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key() < b.key(); });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    if (all || end != i + 2 || is_ridge(bind, triangles, length, sides[i], sides[i + 1]))
      sharp_[at(sides[i].triangle)] |= static_cast<std::uint8_t>(1 << sides[i].k);
    i = end;
  }
  std::vector<int> subset;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (sharp_[t] != 0) subset.push_back(static_cast<int>(t));
  if (!subset.empty()) tree_ = MovingTree(TriangleTree(bind, triangles, std::move(subset)));
}

}  // namespace ft::inline solvers
