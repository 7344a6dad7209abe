#include "solvers/hair/hair_bodies.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

/// Cosine of the angle between directions that are told apart.
constexpr double k_apart = 0.77;

Vec3 face_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double size = n.norm();
  return size > 0 ? Vec3(n / size) : Vec3::Zero();
}

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

HairBodies::HairBodies(std::span<const HairBody> bodies) : given_(bodies), bodies_(bodies.size()) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const std::vector<Vec3> bind = bind_pose_of(*given_[b].trajectory);
    bodies_[b].triangles = given_[b].trajectory->surface().triangles;
    bodies_[b].tree = TriangleTree(bind, bodies_[b].triangles);
    bodies_[b].before = bodies_[b].after = bind;
  }
}

void HairBodies::start_at(double time) {
  end_at(time);
  advance();
}

void HairBodies::end_at(double time) {
  double squared = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    given_[b].trajectory->sample(time, body.after);
    for (std::size_t v = 0; v < body.after.size(); ++v)
      squared = std::max(squared, (body.after[v] - body.before[v]).squaredNorm());
  }
  way_ = std::sqrt(squared);
}

void HairBodies::advance() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    std::swap(bodies_[b].before, bodies_[b].after);
    bodies_[b].tree.refit(bodies_[b].before, triangles(static_cast<int>(b)));
  }
}

void find_candidates(const HairBodies& bodies, const Box& box, std::vector<std::pair<int, int>>& out) {
  out.clear();
  for (int b = 0; b < bodies.count(); ++b)
    bodies.tree(b).for_each_near(TreeBox::around(box.lo, box.hi), [&](int t) { out.emplace_back(b, t); });
}

int find_nearest(const HairBodies& bodies, std::span<const std::pair<int, int>> candidates, const Vec3& point,
                 double least_reach, int most, NearSurface* out, const Vec3* goes) {
  struct Found {
    int body, triangle;
    ClosestOnTriangle closest;
    Vec3 normal;
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
    found.push_back({b, t, c, face_normal(p0, p1, p2)});
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::tuple(a.closest.squared_distance, a.body, a.triangle) <
           std::tuple(b.closest.squared_distance, b.body, b.triangle);
  });
  int count = 0;
  for (std::size_t i = 0; i < found.size() && count < most; ++i) {
    const Found& f = found[i];
    const double distance = std::sqrt(f.closest.squared_distance);
    const Vec3 off = point - f.closest.point;
    // Triangles that share the place: their normals together tell inside from outside.
    Vec3 faces = f.normal;
    for (std::size_t k = 0; k < found.size(); ++k)
      if (k != i && found[k].body == f.body && (found[k].closest.point - f.closest.point).squaredNorm() < 1e-16)
        faces += found[k].normal;
    NearSurface near;
    const bool inside = !bodies.sheet(f.body) && off.dot(faces) < 0;
    near.gap = inside ? -distance : distance;
    near.normal = distance > 1e-7 ? Vec3((inside ? -1 : 1) / distance * off)
                                  : (faces.norm() > 1e-9 ? Vec3(faces.normalized()) : f.normal);
    if (near.normal.isZero(0)) continue;
    bool known = false;
    for (int k = 0; k < count && !known; ++k) known = out[k].normal.dot(near.normal) > k_apart;
    // Where it is outside of the nearest surface, what it is behind of is another sheet of the body.
    if (known || (inside && count > 0)) continue;
    near.body = f.body, near.triangle = f.triangle;
    const Triangle& corner = bodies.triangles(f.body)[at(f.triangle)];
    const auto x = bodies.before(f.body);
    near.weights = barycentric(f.closest.point, x[at(corner[0])], x[at(corner[1])], x[at(corner[2])]);
    out[count++] = near;
  }
  return count;
}

}  // namespace ft::inline solvers
