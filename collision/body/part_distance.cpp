// See part_distance.h.
#include "collision/body/part_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "baker/core/check.h"
#include "baker/core/disjoint_sets.h"
#include "collision/geometry/weld.h"

namespace ft::inline collision {
namespace {

struct HalfEdge {
  Edge edge;
  int triangle, side;
  auto operator<=>(const HalfEdge&) const = default;
};

}  // namespace

PartSurface::PartSurface(std::span<const Vec3> bind, std::span<const Triangle> triangles,
                         std::span<const int> part_of_vertex, int part_count)
    : representative_(weld(bind, part_of_vertex)) {
  const int triangle_count = static_cast<int>(triangles.size());
  triangles_.assign(triangles.begin(), triangles.end());
  part_of_triangle_.resize(triangles.size());
  neighbours_.assign(triangles.size(), {-1, -1, -1});
  rim_vertex_.assign(bind.size(), 0);
  std::vector<HalfEdge> halves;
  std::vector<std::vector<int>> members(at(part_count));
  std::vector<int> whole;
  for (int i = 0; i < triangle_count; ++i) {
    Triangle& t = triangles_[at(i)];
    for (int& v : t) v = representative_[at(v)];
    const int a = part_of_vertex[at(t[0])], b = part_of_vertex[at(t[1])], c = part_of_vertex[at(t[2])];
    part_of_triangle_[at(i)] = a == b || a == c ? a : b == c ? b : std::min({a, b, c});
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    members[at(part_of_triangle_[at(i)])].push_back(i);
    whole.push_back(i);
    for (int k = 0; k < 3; ++k) {
      const int u = t[at(k)], v = t[at((k + 1) % 3)];
      halves.push_back({{std::min(u, v), std::max(u, v)}, i, k});
    }
  }
  std::sort(halves.begin(), halves.end());
  DisjointSets shells(at(part_count));
  closed_.assign(at(part_count), 1);
  for (std::size_t i = 0; i < halves.size();) {
    std::size_t end = i + 1;
    while (end < halves.size() && halves[end].edge == halves[i].edge) ++end;
    const int first_part = part_of_triangle_[at(halves[i].triangle)];
    if (end - i == 2) {
      const HalfEdge &a = halves[i], &b = halves[i + 1];
      neighbours_[at(a.triangle)][at(a.side)] = b.triangle;
      neighbours_[at(b.triangle)][at(b.side)] = a.triangle;
    } else {
      rim_vertex_[at(halves[i].edge[0])] = rim_vertex_[at(halves[i].edge[1])] = 1;
      for (std::size_t k = i; k < end; ++k) closed_[at(part_of_triangle_[at(halves[k].triangle)])] = 0;
    }
    for (std::size_t k = i + 1; k < end; ++k) {
      const int part = part_of_triangle_[at(halves[k].triangle)];
      if (part == first_part) continue;
      closed_[at(part)] = closed_[at(first_part)] = 0;
      shells.join(part, first_part);
    }
    i = end;
  }
  around_ = vertex_triangles(static_cast<int>(bind.size()), triangles_);
  shell_.resize(at(part_count));
  for (int p = 0; p < part_count; ++p) shell_[at(p)] = shells.root(p);
  for (int p = 0; p < part_count; ++p) trees_.emplace_back(bind, triangles_, members[at(p)]);

  // Shells that are inside out are read the other way round.
  std::vector<double> volume(at(part_count), 0.0);
  const Vec3 origin = bind.empty() ? Vec3::Zero().eval() : bind[0];
  std::vector<Vec3> centre(at(part_count), Vec3::Zero());
  std::vector<double> weight(at(part_count), 0.0);
  for (const int i : whole)
    for (const int v : triangles_[at(i)]) {
      const int s = shell_[at(part_of_triangle_[at(i)])];
      centre[at(s)] += bind[at(v)] - origin;
      weight[at(s)] += 1;
    }
  for (const int i : whole) {
    const int s = shell_[at(part_of_triangle_[at(i)])];
    const Vec3 c = origin + centre[at(s)] / weight[at(s)];
    const Triangle& t = triangles_[at(i)];
    volume[at(s)] += (bind[at(t[0])] - c).cross(bind[at(t[1])] - c).dot(bind[at(t[2])] - c);
  }
  outward_.resize(at(part_count));
  for (int p = 0; p < part_count; ++p) outward_[at(p)] = volume[at(shell_[at(p)])] < 0 ? -1.0 : 1.0;

  half_thickness_.resize(at(part_count));
  const TriangleTree all(bind, triangles_, whole);
  for (int p = 0; p < part_count; ++p)
    half_thickness_[at(p)] =
        members[at(p)].empty() ? 0 : measure_half_thickness(p, bind, closed(p) ? trees_[at(p)] : all);
}

Vec3 PartSurface::face_normal(int triangle, std::span<const Vec3> x) const {
  const Triangle& t = triangles_[at(triangle)];
  const Vec3 n = (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]);
  const double length = n.norm();
  return length > 0 ? (n * (outward_[at(part_of_triangle_[at(triangle)])] / length)).eval() : Vec3::Zero().eval();
}

double PartSurface::measure_half_thickness(int part, std::span<const Vec3> bind, const TriangleTree& skin) const {
  // Median length of rays from the part's triangles inwards to the other side, of up to 200 of them.
  const auto& order = trees_[at(part)].order();
  const std::size_t stride = std::max<std::size_t>(1, order.size() / 200);
  std::vector<double> found;
  for (std::size_t k = 0; k < order.size(); k += stride) {
    const int i = order[k];
    const Triangle& t = triangles_[at(i)];
    const Vec3 n = -face_normal(i, bind);
    if (n.isZero()) continue;
    const Vec3 p = (bind[at(t[0])] + bind[at(t[1])] + bind[at(t[2])]) / 3;
    const double hit = skin.ray(p, n, 1.0, i, bind, triangles_);
    if (hit < 1.0) found.push_back(hit);
  }
  if (found.empty()) return 0.02;
  std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2), found.end());
  return 0.5 * found[found.size() / 2];
}

std::optional<PartSurface::Answer> PartSurface::distance(const Vec3& p, std::span<const int> parts,
                                                         std::span<const char> allowed, double reach, const Pose& pose,
                                                         int& hint) const {
  const auto x = pose.positions;
  TriangleTree::Hit hit;
  hit.closest.squared_distance = reach * reach;
  if (hint >= 0) {
    const Triangle& t = triangles_[at(hint)];
    const ClosestOnTriangle guess = closest_on_triangle(p, x[at(t[0])], x[at(t[1])], x[at(t[2])]);
    if (guess.squared_distance < hit.closest.squared_distance) hit = {guess, hint};
  }
  for (const int part : parts) pose.trees[at(part)].closest(p, x, triangles_, hit);
  hint = hit.triangle;
  return judge(p, hit, allowed, x);
}

std::optional<PartSurface::Answer> PartSurface::judge(const Vec3& p, const TriangleTree::Hit& hit,
                                                      std::span<const char> allowed, std::span<const Vec3> x) const {
  if (hit.triangle < 0) return std::nullopt;
  const int feature = hit.closest.feature;
  Vec3 normal = Vec3::Zero();
  if (feature == 6) {
    normal = face_normal(hit.triangle, x);
  } else if (feature >= 3) {
    const int other = neighbours_[at(hit.triangle)][at(feature - 3)];
    if (other < 0 || allowed[at(part_of_triangle_[at(other)])] == 0) return std::nullopt;
    normal = face_normal(hit.triangle, x) + face_normal(other, x);
  } else {
    const int v = triangles_[at(hit.triangle)][at(feature)];
    if (rim_vertex_[at(v)] != 0) return std::nullopt;
    for (const int i : around_.row(v)) {
      if (allowed[at(part_of_triangle_[at(i)])] == 0) return std::nullopt;
      const Triangle& t = triangles_[at(i)];
      const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const Vec3 a = x[at(t[(k + 1) % 3])] - x[at(v)], b = x[at(t[(k + 2) % 3])] - x[at(v)];
      normal += std::atan2(a.cross(b).norm(), a.dot(b)) * face_normal(i, x);
    }
  }
  const double length = normal.norm();
  if (!(length > 0)) return std::nullopt;
  Answer answer;
  answer.point = hit.closest.point;
  answer.normal = normal / length;
  answer.part = part_of_triangle_[at(hit.triangle)];
  const Vec3 offset = p - answer.point;
  answer.distance = std::sqrt(hit.closest.squared_distance);
  if (offset.dot(answer.normal) < 0) answer.distance = -answer.distance;
  if (answer.distance < -depth_limit(answer.part)) return std::nullopt;
  // Away from the surface the way out is the line to the closest point; the pseudo-normal only tells the side.
  if (std::abs(answer.distance) > 1e-7) answer.normal = offset / answer.distance;
  return answer;
}

}  // namespace ft::inline collision
