// See leaf_contact.h: the search. The impulses are in contact_impulses.cpp.
#include "solvers/leaves/leaf_contact.h"

#include <algorithm>
#include <cmath>

#include "collision/geometry/pair_geometry.h"

namespace ft::inline solvers {
namespace {

using Local = ContactScratch::Local;

/// Sine of the angle by which an edge has to stick out to be met by the leaf's edges; flatter ones are faces [1].
constexpr double k_sharp = 0.02;
/// A body's feature that faces the leaf's plane by less than this tells no side [1].
constexpr double k_facing = 0.15;
/// Between a leaf that touches water and the water [1].
constexpr double k_water_friction = 1;
/// Of a leaf's speed in a step, near grounds and water [m/s].
constexpr double k_gain = 0.12;
/// What lies farther inside than this is not pushed out at once but by the certificate [m].
constexpr double k_deepest = 0.05;

Vec3 along(std::span<const Vec3> a, std::span<const Vec3> b, int v, double share) {
  return a[at(v)] + share * (b[at(v)] - a[at(v)]);
}

Vec3 normal_of(const LeafBodies& bodies, int body, int triangle, std::span<const Vec3> a, std::span<const Vec3> b,
               double share) {
  const Triangle& t = bodies.triangles(body)[at(triangle)];
  const Vec3 p = along(a, b, t[0], share);
  return (along(a, b, t[1], share) - p).cross(along(a, b, t[2], share) - p).normalized();
}

void place_triangles(const LeafBodies& bodies, const ContactStep& step, const Box& around, ContactScratch& s) {
  s.local.clear();
  for (const NearTriangle& n : s.near) {
    const auto a = bodies.places(n.body, step.slice - 1), b = bodies.places(n.body, step.slice);
    const Triangle& t = bodies.triangles(n.body)[at(n.triangle)];
    Local local;
    local.body = n.body;
    local.triangle = n.triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      local.x[k] = along(a, b, t[k], step.to);
      local.step[k] = (step.to - step.from) * (b[at(t[k])] - a[at(t[k])]);
      local.box.include(local.x[k]);
      local.box.include((local.x[k] - local.step[k]).eval());
    }
    if (!local.box.overlaps(around)) continue;
    const Vec3 normal = (local.x[1] - local.x[0]).cross(local.x[2] - local.x[0]);
    const double twice_area = normal.norm();
    if (!(twice_area > 0)) continue;
    local.normal = normal / twice_area;
    s.local.push_back(local);
  }
}

/// Vertices of the leaf, and weights.
struct Whose {
  std::array<int, 3> vertices;
  Vec3 weights;
};

void add(const LeafBodies& bodies, const ContactStep& step, const Vec3& centre, const Vec3& place, const Vec3& normal,
         const Vec3& body_step, double gap, int body, const Whose& whose, ContactScratch& s) {
  if (gap > step.reach || gap < -k_deepest) return;
  s.contacts.push_back({place - centre, normal, body_step / step.time, gap, bodies.obstacle(body).friction,
                        bodies.moves(body), body, whose.vertices, whose.weights});
}

/// Vertices of the leaf: the nearest triangle of each body, and of equally near ones that which faces it most.
void meet_faces(const LeafBodies& bodies, const ContactStep& step, const Vec3& centre, ContactScratch& s) {
  for (std::size_t i = 0; i < s.rim.size(); ++i) {
    const Vec3& p = s.rim[i];
    const int v = static_cast<int>(i);
    for (std::size_t first = 0; first < s.local.size();) {
      const int body = s.local[first].body;
      double nearest = (step.reach + k_deepest) * (step.reach + k_deepest), facing = -1;
      const Local* best = nullptr;
      Vec3 point = Vec3::Zero();
      std::size_t k = first;
      for (; k < s.local.size() && s.local[k].body == body; ++k) {
        const Local& l = s.local[k];
        const ClosestOnTriangle c = closest_on_triangle(p, l.x[0], l.x[1], l.x[2]);
        const double tie = 1e-9 * nearest + 1e-18;
        if (c.squared_distance > nearest + tie) continue;
        const double faces = std::abs(l.normal.dot(p - c.point)) / (std::sqrt(c.squared_distance) + 1e-12);
        if (c.squared_distance > nearest - tie && faces <= facing) continue;
        nearest = c.squared_distance, facing = faces, best = &l, point = c.point;
      }
      first = k;
      if (best == nullptr) continue;
      const double distance = std::sqrt(nearest);
      const double side = best->normal.dot(p - point) >= 0 ? 1 : -1;
      const Vec3 normal = distance > 1e-6 ? Vec3(side / distance * (p - point)) : best->normal;
      const PairGeometry g = vertex_face_geometry(p, best->x[0], best->x[1], best->x[2]);
      const Vec3 moved = -(g.weight[1] * best->step[0] + g.weight[2] * best->step[1] + g.weight[3] * best->step[2]);
      add(bodies, step, centre, p, normal, moved, side * distance, body, {{v, v, v}, Vec3::UnitX()}, s);
    }
  }
}

/// Vertices of the body against the leaf's triangles.
void meet_corners(const LeafBodies& bodies, const LeafShape& shape, const ContactStep& step, const Box& around,
                  const Vec3& centre, ContactScratch& s) {
  s.corners.clear();
  for (const Local& l : s.local)
    for (const int v : bodies.triangles(l.body)[at(l.triangle)]) s.corners.push_back({l.body, v});
  std::sort(s.corners.begin(), s.corners.end());
  s.corners.erase(std::unique(s.corners.begin(), s.corners.end()), s.corners.end());
  for (const auto& [body, v] : s.corners) {
    const auto a = bodies.places(body, step.slice - 1), b = bodies.places(body, step.slice);
    const Vec3 q = along(a, b, v, step.to);
    if (!((q.array() >= around.lo.array()).all() && (q.array() <= around.hi.array()).all())) continue;
    Vec3 outward = Vec3::Zero();
    for (const Local& l : s.local) {
      const Triangle& t = bodies.triangles(l.body)[at(l.triangle)];
      if (l.body == body && (t[0] == v || t[1] == v || t[2] == v)) outward += l.normal;
    }
    outward.normalize();
    for (const Triangle& t : shape.triangles) {
      const Vec3 &x0 = s.rim[at(t[0])], &x1 = s.rim[at(t[1])], &x2 = s.rim[at(t[2])];
      const ClosestOnTriangle c = closest_on_triangle(q, x0, x1, x2);
      if (c.feature != 6) continue;
      Vec3 normal = (x1 - x0).cross(x2 - x0).normalized();
      const double faces = normal.dot(outward);
      if (std::abs(faces) < k_facing) continue;
      if (faces < 0) normal = -normal;
      const auto weight = vertex_face_geometry(q, x0, x1, x2).weight;
      add(bodies, step, centre, c.point, normal, (step.to - step.from) * (b[at(v)] - a[at(v)]), normal.dot(c.point - q),
          body, {t, -Vec3(weight[1], weight[2], weight[3])}, s);
    }
  }
}

/// Edges of the leaf against edges of the body that stick out.
void meet_edges(const LeafBodies& bodies, const LeafShape& shape, const ContactStep& step, const Box& around,
                const Vec3& centre, ContactScratch& s) {
  s.edges.clear();
  for (const Local& l : s.local)
    for (const int e : bodies.edges_of(l.body, l.triangle)) s.edges.push_back({l.body, e});
  std::sort(s.edges.begin(), s.edges.end());
  s.edges.erase(std::unique(s.edges.begin(), s.edges.end()), s.edges.end());
  for (const auto& [body, number] : s.edges) {
    const LeafBodies::Side& e = bodies.edges(body)[at(number)];
    const auto a = bodies.places(body, step.slice - 1), b = bodies.places(body, step.slice);
    const Vec3 q0 = along(a, b, e.edge[0], step.to), q1 = along(a, b, e.edge[1], step.to);
    Box box;
    box.include(q0), box.include(q1);
    if (!box.overlaps(around)) continue;
    Vec3 outward = normal_of(bodies, body, e.triangles[0], a, b, step.to);
    if (e.triangles[1] >= 0) {
      const Vec3 other = normal_of(bodies, body, e.triangles[1], a, b, step.to);
      const Triangle& t = bodies.triangles(body)[at(e.triangles[1])];
      const int opposite = t[0] != e.edge[0] && t[0] != e.edge[1]   ? t[0]
                           : t[1] != e.edge[0] && t[1] != e.edge[1] ? t[1]
                                                                    : t[2];
      const Vec3 arm = along(a, b, opposite, step.to) - q0;
      if (arm.dot(outward) > -k_sharp * arm.norm()) continue;
      outward = (outward + other).normalized();
    }
    for (const Edge& mine : shape.edges) {
      const Vec3 &p0 = s.rim[at(mine[0])], &p1 = s.rim[at(mine[1])];
      const PairGeometry g = edge_edge_geometry(p0, p1, q0, q1);
      if (!g.interior || g.distance > step.reach) continue;
      Vec3 normal = g.distance > 1e-7 ? g.normal : Vec3((p1 - p0).cross(q1 - q0).normalized());
      const double faces = normal.dot(outward);
      if (std::abs(faces) < k_facing) continue;
      if (faces < 0) normal = -normal;
      const Vec3 place = g.weight[0] * p0 + g.weight[1] * p1;
      const Vec3 foot = -(g.weight[2] * q0 + g.weight[3] * q1);
      const Vec3 moved = -(step.to - step.from) * (g.weight[2] * (b[at(e.edge[0])] - a[at(e.edge[0])]) +
                                                   g.weight[3] * (b[at(e.edge[1])] - a[at(e.edge[1])]));
      add(bodies, step, centre, place, normal, moved, normal.dot(place - foot), body,
          {{mine[0], mine[1], mine[1]}, Vec3(g.weight[0], g.weight[1], 0)}, s);
    }
  }
}

/// The vertices that can come as near as touching in the step.
void meet_ground(const LeafGround& ground, int met, const ContactStep& step, const Vec3& centre, ContactScratch& s) {
  for (std::size_t i = 0; i < s.rim.size(); ++i) {
    const Vec3& p = s.rim[i];
    const int v = static_cast<int>(i);
    const double gap = p.y() - ground.height,
                 approach = -(step.velocity + step.spin.cross(p - centre)).y() + step.bending;
    if (gap < step.touch + step.time * std::max(0.0, approach + k_gain))
      s.contacts.push_back(
          {p - centre, Vec3::UnitY(), Vec3::Zero(), gap, ground.friction, false, met, {v, v, v}, Vec3::UnitX()});
  }
}

}  // namespace

void find_near(const LeafBodies& bodies, int slice, const Vec3& centre, double reach, std::vector<NearTriangle>& out) {
  out.clear();
  for (int body = 0; body < bodies.count(); ++body) {
    const Vec3 grown = Vec3::Constant(reach + bodies.way(body, slice));
    const Box box{centre - grown, centre + grown};
    if (!box.overlaps(bodies.box(body))) continue;
    const std::size_t first = out.size();
    const Box exact{centre - Vec3::Constant(reach), centre + Vec3::Constant(reach)};
    const auto before = bodies.places(body, slice - 1), after = bodies.places(body, slice);
    bodies.tree(body, slice).for_each_near(TreeBox::around(box.lo, box.hi), [&](int triangle) {
      Box swept;
      for (const int v : bodies.triangles(body)[at(triangle)])
        swept.include(before[at(v)]), swept.include(after[at(v)]);
      if (swept.overlaps(exact)) out.push_back({body, triangle});
    });
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
              [](const NearTriangle& a, const NearTriangle& b) { return a.triangle < b.triangle; });
  }
}

void meet_water(const WaterPatch& water, const ContactStep& step, const Vec3& centre, ContactScratch& s) {
  const Vec3 velocity(water.flow.x(), water.rising(water.flow), water.flow.z());
  for (std::size_t i = 0; i < s.rim.size(); ++i) {
    const Vec3& p = s.rim[i];
    const int v = static_cast<int>(i);
    const Vec3 own = step.velocity + step.spin.cross(p - centre);
    const double approach = (velocity - own).dot(water.normal) + step.bending;
    const double gap = (p.y() - water.height_at(centre, p)) * water.normal.y();
    if (gap < step.touch + step.time * std::max(0.0, approach + k_gain))
      s.contacts.push_back(
          {p - centre, water.normal, velocity, gap, k_water_friction, true, -1, {v, v, v}, Vec3::UnitX()});
  }
}

void find_contacts(const LeafBodies& bodies, std::span<const LeafGround> grounds, const LeafShape& shape,
                   const ContactStep& step, const Vec3& centre, ContactScratch& s) {
  s.contacts.clear();
  for (std::size_t g = 0; g < grounds.size(); ++g) {
    const LeafGround& ground = grounds[g];
    if (centre.y() - shape.radius * 4 > ground.height + step.reach) continue;
    meet_ground(ground, bodies.count() + static_cast<int>(g), step, centre, s);
  }
  if (s.near.empty()) return;
  Box around = bounds(s.rim);
  around.inflate(step.reach);
  place_triangles(bodies, step, around, s);
  if (s.local.empty()) return;
  meet_faces(bodies, step, centre, s);
  meet_corners(bodies, shape, step, around, centre, s);
  meet_edges(bodies, shape, step, around, centre, s);
}

}  // namespace ft::inline solvers
