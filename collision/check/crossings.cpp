// See crossings.h. Candidates by two box trees; each edge is tested from the one triangle that owns it (its first), so
// nothing is tested twice. Degenerate triangles are the segments that they have shrunk to and count like them.
#include "collision/check/crossings.h"

#include <algorithm>

#include "baker/core/parallel.h"
#include "collision/check/crossing_predicates.h"

namespace ft::inline collision {
namespace {

constexpr std::size_t k_tasks = 128;  ///< that a search is split into, about

Vec2 drop(const Vec3& v, int axis) {
  return {v[(axis + 1) % 3], v[(axis + 2) % 3]};
}

bool boxes_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  for (int k = 0; k < 3; ++k)
    if (std::max(p[k], q[k]) < std::min(r[k], s[k]) || std::max(r[k], s[k]) < std::min(p[k], q[k])) return false;
  return true;
}

bool segments_meet_2d(const Vec2& p, const Vec2& q, const Vec2& r, const Vec2& s) {
  for (int k = 0; k < 2; ++k)
    if (std::max(p[k], q[k]) < std::min(r[k], s[k]) || std::max(r[k], s[k]) < std::min(p[k], q[k])) return false;
  return orientation_2d(p, q, r) * orientation_2d(p, q, s) <= 0 &&
         orientation_2d(r, s, p) * orientation_2d(r, s, q) <= 0;
}

/// An axis along which a, b, c do not fall into one line; -1 when they are in line in space.
int injective_axis(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis)
    if (orientation_2d(drop(a, axis), drop(b, axis), drop(c, axis)) != 0) return axis;
  return -1;
}

bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  if (!boxes_meet(p, q, r, s) || orientation(p, q, r, s) != 0) return false;
  int axis = injective_axis(p, q, r);
  if (axis < 0) axis = injective_axis(p, q, s);
  if (axis < 0) axis = injective_axis(p, r, s);
  if (axis < 0) axis = injective_axis(q, r, s);
  // All in one line: intervals meet exactly when their boxes do.
  return axis < 0 || segments_meet_2d(drop(p, axis), drop(q, axis), drop(r, axis), drop(s, axis));
}

bool inside_2d(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
  const int u = orientation_2d(a, b, p), v = orientation_2d(b, c, p), w = orientation_2d(c, a, p);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

/// p, q in the plane of a, b, c; or the triangle has no area.
bool coplanar_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int axis = injective_axis(a, b, c);
  if (axis < 0) return segments_meet(p, q, a, b) || segments_meet(p, q, b, c) || segments_meet(p, q, c, a);
  const Vec2 p2 = drop(p, axis), q2 = drop(q, axis), a2 = drop(a, axis), b2 = drop(b, axis), c2 = drop(c, axis);
  return inside_2d(p2, a2, b2, c2) || segments_meet_2d(p2, q2, a2, b2) || segments_meet_2d(p2, q2, b2, c2) ||
         segments_meet_2d(p2, q2, c2, a2);
}

/// Adds the owned edges of s (in x) that cross t (in y). In one surface, edges that share a vertex with t are left out.
template <bool one_surface>
void edges_through(const Triangle& s, unsigned char owned, std::span<const Vec3> x, const Triangle& t,
                   std::span<const Vec3> y, bool edge_of_first, std::vector<Crossing>& out) {
  const auto in_t = [&](int v) { return v == t[0] || v == t[1] || v == t[2]; };
  for (int k = 0; k < 3; ++k) {
    if ((owned >> k & 1) == 0) continue;
    const int i = s[at(k)], j = s[at((k + 1) % 3)];
    if (one_surface && (in_t(i) || in_t(j))) continue;
    if (edge_crosses_triangle(x[at(i)], x[at(j)], y[at(t[0])], y[at(t[1])], y[at(t[2])]))
      out.push_back({{std::min(i, j), std::max(i, j)}, t, edge_of_first});
  }
}

Box box_of(const Triangle& t, std::span<const Vec3> x) {
  Box box;
  for (const int v : t) box.include(x[at(v)]);
  return box;
}

/// What visit(i, j, found) finds for all pairs of triangles that may meet, of two surfaces or one with itself.
template <class Visit>
std::vector<Crossing> crossings_of_pairs(const CheckedSurface& a, const CheckedSurface& b, Visit&& visit) {
  const auto tasks = a.tree().pair_tasks(b.tree(), k_tasks);
  std::vector<std::vector<Crossing>> found(tasks.size());
  parallel_tasks(tasks.size(), [&](std::size_t task) {
    a.tree().for_each_pair(tasks[task], b.tree(), [&](int i, int j) { visit(i, j, found[task]); });
  });
  std::vector<Crossing> out;
  for (const auto& part : found) out.insert(out.end(), part.begin(), part.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

bool edge_crosses_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int k = 0; k < 3; ++k)
    if (std::max(p[k], q[k]) < std::min({a[k], b[k], c[k]}) || std::max({a[k], b[k], c[k]}) < std::min(p[k], q[k]))
      return false;
  const int side_p = orientation(a, b, c, p), side_q = orientation(a, b, c, q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return coplanar_meet(p, q, a, b, c);
  const int u = orientation(p, q, a, b), v = orientation(p, q, b, c);
  if (u * v < 0) return false;
  const int w = orientation(p, q, c, a);
  return u * w >= 0 && v * w >= 0;
}

bool edge_crosses_any(const Vec3& p, const Vec3& q, const TriangleTree& tree, std::span<const Vec3> positions,
                      std::span<const Triangle> triangles) {
  bool out = false;
  tree.for_each_near(TreeBox::around(p.cwiseMin(q), p.cwiseMax(q)), [&](int t) {
    const Triangle& c = triangles[at(t)];
    out = out || edge_crosses_triangle(p, q, positions[at(c[0])], positions[at(c[1])], positions[at(c[2])]);
  });
  return out;
}

std::vector<Crossing> crossings_between(const CheckedSurface& a, const CheckedSurface& b) {
  if (a.empty() || b.empty()) return {};
  return crossings_of_pairs(a, b, [&](int i, int j, std::vector<Crossing>& out) {
    const Triangle &s = a.triangles()[at(i)], &t = b.triangles()[at(j)];
    if (!box_of(s, a.positions()).overlaps(box_of(t, b.positions()))) return;
    edges_through<false>(s, a.owned_edges(i), a.positions(), t, b.positions(), true, out);
    edges_through<false>(t, b.owned_edges(j), b.positions(), s, a.positions(), false, out);
  });
}

std::vector<Crossing> crossings_within(const CheckedSurface& a) {
  if (a.empty()) return {};
  const auto x = a.positions();
  return crossings_of_pairs(a, a, [&](int i, int j, std::vector<Crossing>& out) {
    const Triangle &s = a.triangles()[at(i)], &t = a.triangles()[at(j)];
    if (!box_of(s, x).overlaps(box_of(t, x))) return;
    edges_through<true>(s, a.owned_edges(i), x, t, x, true, out);
    edges_through<true>(t, a.owned_edges(j), x, s, x, true, out);
  });
}

std::vector<Crossing> crossings_between(std::span<const Vec3> positions_a, std::span<const Triangle> triangles_a,
                                        std::span<const Vec3> positions_b, std::span<const Triangle> triangles_b) {
  CheckedSurface a(triangles_a), b(triangles_b);
  a.move(positions_a);
  b.move(positions_b);
  return crossings_between(a, b);
}

std::vector<Crossing> crossings_within(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  CheckedSurface a(triangles);
  a.move(positions);
  return crossings_within(a);
}

}  // namespace ft::inline collision
