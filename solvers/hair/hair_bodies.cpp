#include "solvers/hair/hair_bodies.h"

#include <algorithm>
#include <cmath>

#include "collision/check/crossings.h"
#include "collision/check/penetration.h"
#include "collision/geometry/pair_geometry.h"

namespace ft::inline solvers {
namespace {

/// Cosine of the angle between directions that are told apart.
constexpr double k_apart = 0.77;
/// What is said to be deeper inside than this is asked by rays, too; and what is outside of a triangle by less, and
/// behind another that is farther by less [m].
constexpr double k_deep = 1e-3;

/// Of a point of the plane of a triangle.
Vec3 barycentric(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, w = p - a;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), wu = w.dot(u), wv = w.dot(v);
  const double bottom = uu * vv - uv * uv;
  if (!(bottom > 0)) return Vec3(1, 0, 0);
  const double s = (vv * wu - uv * wv) / bottom, t = (uu * wv - uv * wu) / bottom;
  return Vec3(1 - s - t, s, t);
}

}  // namespace

HairBodies::HairBodies(std::span<const HairBody> bodies, double segment) : given_(bodies), bodies_(bodies.size()) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const std::vector<Vec3> bind = bind_pose_of(*given_[b].trajectory);
    bodies_[b].triangles = given_[b].trajectory->surface().triangles;
    bodies_[b].tree = MovingTree(TriangleTree(bind, bodies_[b].triangles));
    if (segment > 0) bodies_[b].edges = SharpEdges(bind, bodies_[b].triangles, segment, given_[b].sheet);
    bodies_[b].before = bodies_[b].after = bind;
    if (!given_[b].sheet) bodies_[b].surface.emplace(bind, bodies_[b].triangles, std::vector<int>(bind.size(), 0), 1);
  }
}

void HairBodies::start_at(double time) {
  end_at(time);
  advance();
}

void HairBodies::end_at(double time, const Vec3& common) {
  common_ = common;
  double squared = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    given_[b].trajectory->sample(time, body.after);
    ways_.resize(body.after.size());
    for (std::size_t v = 0; v < body.after.size(); ++v) {
      const Vec3 goes = body.after[v] - body.before[v];
      squared = std::max(squared, goes.squaredNorm());
      ways_[v] = (goes - common).squaredNorm();
    }
    body.tree.set_ways(ways_, body.triangles);
    body.edges.tree().set_ways(ways_, body.triangles);
  }
  way_ = std::sqrt(squared);
}

void HairBodies::advance() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    std::swap(bodies_[b].before, bodies_[b].after);
    bodies_[b].tree.refit(bodies_[b].before, triangles(static_cast<int>(b)));
    bodies_[b].edges.tree().refit(bodies_[b].before, triangles(static_cast<int>(b)));
  }
}

bool HairBodies::inside(int body, const Vec3& point, const TriangleTree::Hit& hit, Vec3& normal) const {
  const Body& own = bodies_[at(body)];
  if (!own.surface) return false;
  const char one = 1;
  const auto answer = own.surface->judge(point, hit, {&one, 1}, own.before);
  if (!answer) return false;
  normal = answer->normal;
  const auto by_rays = [&] { return rays_say_inside(point, own.tree.tree(), own.before, own.triangles); };
  if (answer->distance >= 0)
    return answer->distance < k_deep && own.surface->closed(0) &&
           is_behind_any(own, point, answer->distance + k_deep) && by_rays();
  return answer->distance > -k_deep || !own.surface->closed(0) || by_rays();
}

/// Whether a point is behind a triangle within a distance: where skin is folded over, the nearest one may face inwards.
bool HairBodies::is_behind_any(const Body& body, const Vec3& point, double distance) {
  bool out = false;
  body.tree.tree().for_each_near(TreeBox::around(point.array() - distance, point.array() + distance), [&](int t) {
    if (out) return;
    const Triangle& corner = body.triangles[at(t)];
    const Vec3 &a = body.before[at(corner[0])], &b = body.before[at(corner[1])], &c = body.before[at(corner[2])];
    if ((b - a).cross(c - a).dot(point - a) >= 0) return;
    out = closest_on_triangle(point, a, b, c).squared_distance < distance * distance;
  });
  return out;
}

bool HairBodies::rays_inside(const Vec3& point) const {
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
    return body.surface && body.surface->closed(0) &&
           rays_say_inside(point, body.tree.tree(), body.before, body.triangles);
  });
}

bool HairBodies::has_sheets() const {
  return std::ranges::any_of(given_, &HairBody::sheet);
}

bool HairBodies::through_sheet(const Vec3& a, const Vec3& b) const {
  bool out = false;
  for (int k = 0; k < count() && !out; ++k)
    out = sheet(k) && edge_crosses_any(a, b, tree(k).tree(), before(k), triangles(k));
  return out;
}

std::optional<HairBodies::Nearest> HairBodies::nearest(const Vec3& point, double look) const {
  std::optional<Nearest> out;
  for (int b = 0; b < count(); ++b) {
    TriangleTree::Hit hit;
    hit.closest.squared_distance = look * look;
    tree(b).tree().closest(point, before(b), triangles(b), hit);
    if (hit.triangle < 0) continue;
    Nearest near;
    const double distance = std::sqrt(hit.closest.squared_distance);
    const bool is_inside = inside(b, point, hit, near.normal);
    near.gap = is_inside ? -distance : distance;
    near.place = hit.closest.point;
    if (distance > 1e-7) near.normal = (is_inside ? -1 : 1) / distance * (point - near.place);
    if (!out || near.gap < out->gap) out = near;
  }
  return out;
}

double HairBodies::depth(const Vec3& point, double look) const {
  const auto near = nearest(point, look);
  return near ? -near->gap : -look;
}

void find_candidates(const HairBodies& bodies, const Box& box, double reach, std::vector<std::pair<int, int>>& out) {
  out.clear();
  for (int b = 0; b < bodies.count(); ++b)
    bodies.tree(b).for_each_within(box.lo, box.hi, reach, [&](int t) { out.emplace_back(b, t); });
}

int find_nearest(const HairBodies& bodies, std::span<const std::pair<int, int>> candidates, const Vec3& point,
                 double least_reach, int most, NearSurface* out, const Vec3* goes) {
  struct Found {
    int body;
    TriangleTree::Hit hit;
  };
  thread_local std::vector<Found> found;
  found.clear();
  for (const auto& [b, t] : candidates) {
    const Triangle& corner = bodies.triangles(b)[at(t)];
    const auto x = bodies.before(b);
    const Vec3 &p0 = x[at(corner[0])], &p1 = x[at(corner[1])], &p2 = x[at(corner[2])];
    const double reach = least_reach + (goes ? (*goes - (bodies.after(b)[at(corner[0])] - p0)).norm() : 0.0);
    // The box first: most candidates of a group are far from this point.
    const Vec3 lo = p0.cwiseMin(p1).cwiseMin(p2), hi = p0.cwiseMax(p1).cwiseMax(p2);
    if ((lo - point).cwiseMax(point - hi).cwiseMax(0.0).squaredNorm() > reach * reach) continue;
    const ClosestOnTriangle c = closest_on_triangle(point, p0, p1, p2);
    if (c.squared_distance > reach * reach) continue;
    found.push_back({b, {c, t}});
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::tuple(a.hit.closest.squared_distance, a.body, a.hit.triangle) <
           std::tuple(b.hit.closest.squared_distance, b.body, b.hit.triangle);
  });
  int count = 0;
  for (std::size_t i = 0; i < found.size() && count < most; ++i) {
    const Found& f = found[i];
    const double distance = std::sqrt(f.hit.closest.squared_distance);
    const Vec3 off = point - f.hit.closest.point;
    NearSurface near;
    near.normal = Vec3::Zero();
    const bool inside = bodies.inside(f.body, point, f.hit, near.normal);
    near.gap = inside ? -distance : distance;
    if (distance > 1e-7) near.normal = (inside ? -1 : 1) / distance * off;
    if (near.normal.isZero(0)) continue;
    bool known = false;
    for (int k = 0; k < count && !known; ++k) known = out[k].normal.dot(near.normal) > k_apart;
    // Where it is outside of the nearest surface, what it is behind of is another sheet of the body.
    if (known || (inside && count > 0)) continue;
    near.body = f.body, near.triangle = f.hit.triangle;
    const Triangle& corner = bodies.triangles(f.body)[at(f.hit.triangle)];
    const auto x = bodies.before(f.body);
    near.weights = barycentric(f.hit.closest.point, x[at(corner[0])], x[at(corner[1])], x[at(corner[2])]);
    out[count++] = near;
  }
  return count;
}

std::optional<NearEdge> find_nearest_edge(const HairBodies& bodies, const Vec3& a, const Vec3& b, double least_reach,
                                          const Vec3* a_goes, const Vec3* b_goes) {
  /// Nearer to an end than this share of the segment, the end's own contacts do.
  constexpr double k_end = 0.03;
  const double beside = a_goes ? std::max((*a_goes - bodies.common()).norm(), (*b_goes - bodies.common()).norm()) : 0.0;
  const Vec3 low = a.cwiseMin(b), high = a.cwiseMax(b);
  std::optional<NearEdge> out;
  double least = std::numeric_limits<double>::infinity();
  for (int body = 0; body < bodies.count(); ++body) {
    const auto x = bodies.before(body), after = bodies.after(body);
    bodies.edges(body).for_each_within(low, high, least_reach + beside, [&](int t, int k) {
      const Triangle& corner = bodies.triangles(body)[at(t)];
      const int from = corner[at(k)], to = corner[at((k + 1) % 3)];
      double reach = least_reach;
      if (a_goes) {
        const Vec3 goes = after[at(from)] - x[at(from)];
        reach += std::max((*a_goes - goes).norm(), (*b_goes - goes).norm());
      }
      // The box first: most edges are far away.
      const Vec3 lo = x[at(from)].cwiseMin(x[at(to)]), hi = x[at(from)].cwiseMax(x[at(to)]);
      const double most = std::min(reach, least);
      if ((lo - high).cwiseMax(low - hi).cwiseMax(0.0).squaredNorm() > most * most) return;
      const PairGeometry pair = edge_edge_geometry(a, b, x[at(from)], x[at(to)]);
      const double share = pair.weight[1];
      if (!(pair.distance > 1e-7 && pair.distance < most) || share < k_end || share > 1 - k_end) return;
      least = pair.distance;
      NearEdge found{{body, t, Vec3::Zero(), pair.normal, pair.distance}, share};
      found.surface.weights[k] = -pair.weight[2], found.surface.weights[(k + 1) % 3] = -pair.weight[3];
      out = found;
    });
  }
  if (!out || bodies.sheet(out->surface.body)) return out;
  // Whether the segment has got inside there.
  const Vec3 place = a + out->share * (b - a);
  thread_local std::vector<std::pair<int, int>> candidates;
  find_candidates(bodies, {place, place}, least, candidates);
  std::erase_if(candidates, [&](const auto& c) { return c.first != out->surface.body; });
  NearSurface near;
  if (find_nearest(bodies, candidates, place, 1.001 * least, 1, &near) > 0 && near.gap < 0) out->surface = near;
  return out;
}

}  // namespace ft::inline solvers
