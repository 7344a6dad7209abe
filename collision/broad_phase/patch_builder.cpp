#include "collision/broad_phase/patch_builder.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ft::inline collision {
namespace {

constexpr double k_spacing = 1.5;  ///< of seeds, in mean sides
constexpr double k_margin = 0.7;   ///< how far a patch reaches beyond that, in mean sides, besides the reach of pairs
constexpr double k_sliver = 0.01;  ///< twice the area by the square of the longest side, at least
constexpr double k_inside = 1e-5;  ///< of a patch's radius: what an edge may cut into a hull by rounding

double cross2(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distance_to_origin(const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const double t = std::clamp(-a.dot(way) / std::max(way.squaredNorm(), 1e-300), 0.0, 1.0);
  return (a + t * way).norm();
}

/// Counter-clockwise, of at least three points that are not on a line; else what there is.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  std::vector<Vec2> hull(2 * points.size());
  std::size_t size = 0;
  const auto add = [&](const Vec2& p, std::size_t keep) {
    while (size >= keep && cross2(hull[size - 1] - hull[size - 2], p - hull[size - 2]) <= 0) --size;
    hull[size++] = p;
  };
  for (const Vec2& p : points) add(p, 2);
  const std::size_t lower = size + 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.resize(size > 1 ? size - 1 : size);
  return hull;
}

/// Whether the segment comes deeper into the convex polygon than `tolerance`.
bool cuts(const std::vector<Vec2>& hull, const Vec2& a, const Vec2& b, double tolerance) {
  double from = 0, to = 1;
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Vec2& p = hull[k];
    const Vec2 along = (hull[(k + 1) % hull.size()] - p).normalized();
    const double at_a = cross2(along, a - p) - tolerance, at_b = cross2(along, b - p) - tolerance;
    if (at_a <= 0 && at_b <= 0) return false;
    if (at_a > 0 && at_b > 0) continue;
    const double crossing = at_a / (at_a - at_b);
    (at_a > 0 ? to : from) = at_a > 0 ? std::min(to, crossing) : std::max(from, crossing);
    if (from >= to) return false;
  }
  return true;
}

}  // namespace

/// A patch on its way: what can be reached of the mesh inside the circle.
struct PatchBuilder::Spread {
  double radius = 0;                         ///< of the circle about the seed, which lies at 0 [m]
  std::vector<int> triangles;                ///< in the order in which they were reached
  std::vector<std::array<Vec2, 3>> corners;  ///< of these, on the plane
  std::map<int, int> place;                  ///< of a triangle in the list
  std::vector<std::array<Vec2, 2>> ends;     ///< sides inside the circle behind which nothing can be reached
  std::vector<char> is_member;
  std::vector<Vec2> hull;  ///< of the members

  bool inside(std::size_t k) const {
    return std::all_of(corners[k].begin(), corners[k].end(), [&](const Vec2& p) { return p.norm() <= radius; });
  }
  bool any_end_cuts_hull() const {
    return std::any_of(ends.begin(), ends.end(),
                       [&](const auto& end) { return cuts(hull, end[0], end[1], k_inside * radius); });
  }
  /// Whether triangle k is on the other side of one of the hull's sides.
  bool apart_from_hull(std::size_t k) const {
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Vec2 along = hull[(i + 1) % hull.size()] - hull[i];
      if (std::all_of(corners[k].begin(), corners[k].end(),
                      [&](const Vec2& p) { return cross2(along, p - hull[i]) <= 0; }))
        return true;
    }
    return false;
  }
};

PatchBuilder::PatchBuilder(std::span<const Vec3> rest, std::span<const Triangle> triangles, double reach)
    : rest_(rest), triangles_(triangles), reach_(reach) {
  around_ = vertex_triangles(static_cast<int>(rest.size()), triangles);
  struct Side {
    Edge edge;
    int triangle, corner;
  };
  std::vector<Side> sides;
  std::vector<double> length(rest.size()), count(rest.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [lo, hi] = std::minmax(triangles[t][at(k)], triangles[t][at((k + 1) % 3)]);
      sides.push_back({{lo, hi}, static_cast<int>(t), k});
      for (const int v : {lo, hi}) length[at(v)] += (rest[at(lo)] - rest[at(hi)]).norm(), count[at(v)] += 1;
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.edge != b.edge ? a.edge < b.edge : a.triangle < b.triangle; });
  across_.assign(triangles.size(), {-1, -1, -1});
  for (std::size_t k = 0; k < sides.size();) {
    std::size_t end = k;
    while (end < sides.size() && sides[end].edge == sides[k].edge) ++end;
    // Triangles that pass their side in the same direction are wound against each other: where they face the same way
    // they lie on the same side of it, folded together.
    const auto first_of = [&](const Side& s) { return triangles[at(s.triangle)][at(s.corner)]; };
    if (end - k == 2 && first_of(sides[k]) != first_of(sides[k + 1])) {
      across_[at(sides[k].triangle)][at(sides[k].corner)] = sides[k + 1].triangle;
      across_[at(sides[k + 1].triangle)][at(sides[k + 1].corner)] = sides[k].triangle;
    }
    k = end;
  }
  side_.resize(rest.size());
  for (std::size_t v = 0; v < rest.size(); ++v) side_[v] = count[v] > 0 ? length[v] / count[v] : 0;
}

double PatchBuilder::spacing(int vertex) const {
  return std::max(k_spacing * side_[at(vertex)], 0.5 * reach_);
}

std::vector<int> PatchBuilder::seeds() const {
  std::vector<int> seeds, queue;
  std::vector<char> near(rest_.size(), 0);
  std::vector<int> seen(rest_.size(), -1);
  for (int v = 0; v < static_cast<int>(rest_.size()); ++v) {
    if (near[at(v)] != 0 || around_.row(v).empty()) continue;
    seeds.push_back(v);
    const double distance = spacing(v);
    queue.assign(1, v);
    seen[at(v)] = v;
    for (std::size_t k = 0; k < queue.size(); ++k) {
      near[at(queue[k])] = 1;
      for (const int t : around_.row(queue[k]))
        for (const int w : triangles_[at(t)])
          if (seen[at(w)] != v && (rest_[at(w)] - rest_[at(v)]).norm() <= distance) seen[at(w)] = v, queue.push_back(w);
    }
  }
  return seeds;
}

bool PatchBuilder::usable(int triangle, const Vec3& normal) const {
  const Triangle& t = triangles_[at(triangle)];
  const Vec3 a = rest_[at(t[1])] - rest_[at(t[0])], b = rest_[at(t[2])] - rest_[at(t[0])], n = a.cross(b);
  const double longest2 = std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()});
  return n.norm() >= k_sliver * longest2 && n.dot(normal) >= k_facing * n.norm() && longest2 > 0;
}

/// Follows the triangles from `first` on, over every side that comes into the circle.
void PatchBuilder::reach(int first, int seed, const Vec3& normal, const std::array<Vec3, 2>& axes,
                         Spread& found) const {
  const auto on_plane = [&](int v) {
    const Vec3 from_seed = rest_[at(v)] - rest_[at(seed)];
    return Vec2(axes[0].dot(from_seed), axes[1].dot(from_seed));
  };
  const auto add = [&](int t) {
    if (!found.place.emplace(t, static_cast<int>(found.triangles.size())).second) return;
    const Triangle& v = triangles_[at(t)];
    found.triangles.push_back(t);
    found.corners.push_back({on_plane(v[0]), on_plane(v[1]), on_plane(v[2])});
  };
  add(first);
  for (std::size_t k = 0; k < found.triangles.size(); ++k)
    for (std::size_t side = 0; side < 3; ++side) {
      const Vec2 a = found.corners[k][side], b = found.corners[k][(side + 1) % 3];
      if (distance_to_origin(a, b) > found.radius) continue;
      const int next = across_[at(found.triangles[k])][side];
      if (next >= 0 && usable(next, normal))
        add(next);
      else
        found.ends.push_back({a, b});
    }
}

/// Whether the triangles around every vertex inside the circle lie there once: a ray from it meets one of them.
bool PatchBuilder::lies_once(const Spread& found) const {
  std::map<int, int> met;
  for (std::size_t k = 0; k < found.triangles.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& c = found.corners[k];
      if (c[i].norm() <= found.radius && c[(i + 1) % 3].y() <= c[i].y() && c[(i + 2) % 3].y() > c[i].y() &&
          ++met[triangles_[at(found.triangles[k])][i]] > 1)
        return false;
    }
  return true;
}

/// Members: all that is inside the circle; and where an end cuts the hull of that, triangle by triangle as many as have
/// one that none cuts. Each has a side in common with one before it.
void PatchBuilder::choose_members(Spread& found) const {
  const auto choose = [&](bool one_by_one) {
    found.is_member.assign(found.triangles.size(), 0);
    found.hull.clear();
    std::vector<Vec2> points;
    for (std::size_t k = 0; k < found.triangles.size(); ++k) {
      const auto& across = across_[at(found.triangles[k])];
      const bool joins = k == 0 || std::any_of(across.begin(), across.end(), [&](int t) {
                           const auto it = found.place.find(t);
                           return it != found.place.end() && found.is_member[at(it->second)] != 0;
                         });
      if (!joins || !found.inside(k)) continue;
      found.is_member[k] = 1;
      points.insert(points.end(), found.corners[k].begin(), found.corners[k].end());
      if (!one_by_one) continue;
      std::vector<Vec2> before = convex_hull(points);
      found.hull.swap(before);
      if (found.any_end_cuts_hull()) found.hull.swap(before), found.is_member[k] = 0;
      points = found.hull;
    }
    if (!one_by_one && !points.empty()) found.hull = convex_hull(std::move(points));
  };
  choose(false);
  if (found.any_end_cuts_hull()) choose(true);
}

SpreadPatch PatchBuilder::spread(int seed) const {
  SpreadPatch patch;
  const auto around = around_.row(seed);
  const auto area_normal = [&](int t) {
    const Triangle& v = triangles_[at(t)];
    return (rest_[at(v[1])] - rest_[at(v[0])]).cross(rest_[at(v[2])] - rest_[at(v[0])]).eval();
  };
  Vec3 normal = Vec3::Zero();
  for (const int t : around) normal += area_normal(t);
  if (!(normal.norm() > 0)) return patch;
  normal.normalize();
  const auto first = std::find_if(around.begin(), around.end(), [&](int t) { return usable(t, normal); });
  if (first == around.end()) return patch;
  patch.axes[0] = normal.unitOrthogonal();
  patch.axes[1] = normal.cross(patch.axes[0]);

  Spread found;
  found.radius = spacing(seed) + k_margin * side_[at(seed)] + reach_;
  reach(*first, seed, normal, patch.axes, found);
  if (!lies_once(found)) return patch;
  choose_members(found);

  double least_facing = 1;
  for (std::size_t k = 0; k < found.triangles.size(); ++k) {
    const int t = found.triangles[k];
    if (found.is_member[k] != 0)
      patch.members.push_back(t);
    else if (found.apart_from_hull(k))
      continue;
    patch.cover.push_back(t);
    const Vec3 n = area_normal(t);
    least_facing = std::min(least_facing, n.dot(normal) / n.norm());
  }
  patch.stretch = 1 / least_facing;
  std::sort(patch.members.begin(), patch.members.end());
  std::sort(patch.cover.begin(), patch.cover.end());
  return patch;
}

}  // namespace ft::inline collision
