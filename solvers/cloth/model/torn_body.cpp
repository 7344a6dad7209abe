#include "solvers/cloth/model/torn_body.h"

#include <algorithm>
#include <array>

#include "baker/core/mesh.h"

namespace ft::inline solvers {
namespace {

/// Skin is torn where an edge is so many times as long as in the bind pose [1], and longer by so much [m]: more than
/// arms of rubber.
constexpr double k_most_stretch = 5, k_least_gap = 0.15;
/// A part leaps where it moves against the body by more than this [m] and than its own size, and neither in the frame
/// before nor in the next as if it were going there. A kick moves a foot by 0.6 m.
constexpr double k_least_leap = 0.6;

Vec3 median(std::vector<Vec3> values) {
  Vec3 out = Vec3::Zero();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  for (int axis = 0; axis < 3; ++axis) {
    std::nth_element(values.begin(), middle, values.end(),
                     [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
    out[axis] = (*middle)[axis];
  }
  return out;
}

std::vector<Vec3> moves(std::span<const Vec3> from, std::span<const Vec3> to) {
  std::vector<Vec3> out(from.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = to[i] - from[i];
  return out;
}

/// Displacements against the body's median one.
std::vector<Vec3> own_moves(std::span<const Vec3> from, std::span<const Vec3> to) {
  std::vector<Vec3> out = moves(from, to);
  const Vec3 common = median(out);
  for (Vec3& move : out) move -= common;
  return out;
}

}  // namespace

TornBody::TornBody(std::span<const Vec3> bind, std::span<const Triangle> triangles, std::span<const int> part_of_vertex)
    : edges_(unique_edges(triangles)), part_(part_of_vertex.begin(), part_of_vertex.end()) {
  for (const auto& [a, b] : edges_) {
    const double length = (bind[at(a)] - bind[at(b)]).norm();
    longest_.push_back(std::max(k_most_stretch * length, length + k_least_gap));
  }
  std::vector<Box> boxes(part_.empty() ? 0 : at(*std::max_element(part_.begin(), part_.end()) + 1));
  for (std::size_t i = 0; i < part_.size(); ++i) boxes[at(part_[i])].include(bind[i]);
  for (const Box& box : boxes) farthest_.push_back(std::max(k_least_leap, box.size().norm()));
}

Vec3 TornBody::common_move(std::span<const Vec3> start, std::span<const Vec3> end) {
  return median(moves(start, end));
}

std::vector<char> TornBody::find(std::span<const Vec3> start, std::span<const Vec3> end,
                                 const Neighbour& neighbour) const {
  std::vector<char> torn(start.size(), 0);
  bool any = false;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto [a, b] = edges_[e];
    const double most = longest_[e] * longest_[e];
    if ((start[at(a)] - start[at(b)]).squaredNorm() <= most && (end[at(a)] - end[at(b)]).squaredNorm() <= most)
      continue;
    torn[at(a)] = torn[at(b)] = 1;
    any = true;
  }
  const std::vector<Vec3> own = own_moves(start, end);
  std::vector<std::size_t> far;
  for (std::size_t i = 0; i < own.size(); ++i)
    if (own[i].norm() > farthest_[at(part_[i])]) far.push_back(i);
  if (!far.empty()) {
    const std::vector<Vec3> before = own_moves(neighbour(-1), start), after = own_moves(end, neighbour(1));
    for (const std::size_t i : far) {
      const double least = farthest_[at(part_[i])];
      if ((own[i] - before[i]).norm() <= least || (own[i] - after[i]).norm() <= least) continue;
      torn[i] = 1;
      any = true;
    }
  }
  if (!any) torn.clear();
  return torn;
}

}  // namespace ft::inline solvers
