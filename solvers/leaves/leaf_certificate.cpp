#include "solvers/leaves/leaf_certificate.h"

#include <algorithm>
#include <cmath>

#include "collision/check/crossings.h"
#include "collision/check/penetration.h"

namespace ft::inline solvers {

namespace {

/// Caches round to 24 bits: what touches before that crosses after it [m].
constexpr double k_clear = 1e-5;

}  // namespace

LeafVerdict judge_leaf(const LeafBodies& bodies, std::span<const LeafGround> grounds, const LeafShape& shape,
                       std::span<const Vec3> rim, const Vec3& centre, int slice, double slice_time) {
  LeafVerdict out;
  for (const LeafGround& ground : grounds)
    for (const Vec3& p : rim) out.below_ground = std::max(out.below_ground, ground.height + k_clear - p.y());
  const Box box = bounds(rim);
  for (int body = 0; body < bodies.count(); ++body) {
    if (!box.overlaps(bodies.box(body))) continue;
    const auto x = bodies.places(body, slice), before = bodies.places(body, slice - 1);
    const auto triangles = bodies.triangles(body);
    const TriangleTree& tree = bodies.tree(body, slice);
    bodies.tree(body, slice).for_each_near(TreeBox::around(box.lo, box.hi), [&](int number) {
      const Triangle& t = triangles[at(number)];
      const Vec3 &a = x[at(t[0])], &b = x[at(t[1])], &c = x[at(t[2])];
      int here = 0;
      for (const Edge& e : shape.edges) here += edge_crosses_triangle(rim[at(e[0])], rim[at(e[1])], a, b, c);
      for (const Triangle& mine : shape.triangles)
        for (std::size_t k = 0; k < 3; ++k)
          here += edge_crosses_triangle(x[at(t[k])], x[at(t[(k + 1) % 3])], rim[at(mine[0])], rim[at(mine[1])],
                                        rim[at(mine[2])]);
      if (here == 0) return;
      out.crossings += here;
      out.out += (b - a).cross(c - a).normalized();
      out.velocity = (x[at(t[0])] - before[at(t[0])]) / slice_time;
    });
    if (out.crossings > 0 || !bodies.closed(body) || !rays_say_inside(centre, tree, x, triangles)) continue;
    TriangleTree::Hit hit;
    tree.closest(centre, x, triangles, hit);
    out.inside = true;
    out.depth = std::sqrt(hit.closest.squared_distance);
    out.out = out.depth > 1e-9 ? Vec3((hit.closest.point - centre) / out.depth) : Vec3::UnitY();
    const int v = triangles[at(hit.triangle)][0];
    out.velocity = (x[at(v)] - before[at(v)]) / slice_time;
  }
  out.out = out.out.norm() > 1e-9 ? Vec3(out.out.normalized()) : Vec3::Zero();
  return out;
}

double bring_out(const LeafBodies& bodies, std::span<const LeafGround> grounds, const LeafShape& shape,
                 std::vector<Vec3>& rim, Vec3& centre, int slice, double slice_time, double margin,
                 LeafVerdict& verdict) {
  const Vec3 start = centre;
  const auto go = [&](const Vec3& way) {
    for (Vec3& p : rim) p += way;
    centre += way;
    verdict = judge_leaf(bodies, grounds, shape, rim, centre, slice, slice_time);
  };
  const Vec3 velocity = verdict.velocity;
  double step = margin;
  for (int attempt = 0; attempt < 48 && !verdict.ok(); ++attempt) {
    if (verdict.below_ground > 0) {
      go((verdict.below_ground + margin) * Vec3::UnitY());
    } else {
      // First as its crossings say; where that leads nowhere, upwards.
      const bool up = attempt >= 16 || verdict.out.isZero();
      if (attempt == 16) step = margin;
      go((step + (verdict.inside ? verdict.depth : 0.0)) * (up ? Vec3::UnitY() : verdict.out).eval());
      step = std::min(1.5 * step, 0.5);
    }
  }
  const bool found = verdict.ok();
  // Not only just: as much farther again, where there is room.
  if (const Vec3 way = centre - start; found && way.norm() > 0) {
    go(0.5 * margin * way.normalized());
    if (!verdict.ok()) go(-0.5 * margin * way.normalized());
  }
  verdict.velocity = velocity;
  return found ? (centre - start).norm() : -(centre - start).norm();
}

}  // namespace ft::inline solvers
