#include "solvers/hair/sheet_passage.h"

#include "baker/core/mesh.h"
#include "collision/check/crossings.h"
#include "collision/geometry/ccd_li2021.h"

namespace ft::inline solvers {
namespace {

using Corners = std::array<Vec3, 3>;

Corners corners_of(std::span<const Vec3> x, const Triangle& t) {
  return {x[at(t[0])], x[at(t[1])], x[at(t[2])]};
}

bool crosses(const Vec3& a, const Vec3& b, const Corners& c) {
  return edge_crosses_triangle(a, b, c[0], c[1], c[2]);
}

/// A vertex or the inside of a segment and a triangle or one of its edges, in a step.
struct Pair {
  PairKind kind;
  std::array<Vec3, 4> x, dx;
  std::array<int, 3> corner;  ///< of the triangle: the vertices of `x` that are not the strand's
};

/// The soonest meeting so far.
struct Soonest {
  double time = 1;
  std::optional<NearEdge> found;

  void look(const Pair& pair, int body, int triangle, const Corners& before, const Corners& after, double vertex) {
    // As near as the pair starts or nearer, down to nothing that rounding could not tell.
    const CcdSettings settings{.gap_kept = 0.1, .floor = 1e-7};
    const double meets = ccd_time(pair.kind, pair.x, pair.dx, settings);
    if (!(meets < time)) return;
    std::array<Vec3, 4> x = pair.x;
    for (std::size_t k = 0; k < 4; ++k) x[k] += meets * pair.dx[k];
    const PairGeometry near = pair_geometry(pair.kind, x);
    if (!(near.distance > 0)) return;
    Corners then;
    for (std::size_t k = 0; k < 3; ++k) then[k] = before[k] + meets * (after[k] - before[k]);
    const Mat3 back =
        triangle_frame(before[0], before[1], before[2]) * triangle_frame(then[0], then[1], then[2]).transpose();
    NearEdge out{{body, triangle, Vec3::Zero(), back * near.normal, near.distance}, vertex};
    const bool edges = pair.kind == PairKind::k_edge_edge;
    if (edges) out.share = near.weight[1];
    for (std::size_t k = edges ? 2 : 1, c = 0; k < 4; ++k, ++c) out.surface.weights[pair.corner[c]] = -near.weight[k];
    time = meets;
    found = out;
  }
};

}  // namespace

std::optional<NearEdge> find_sheet_passage(const HairBodies& bodies, const SegmentStep& segment) {
  const auto& [a, b, a_after, b_after] = segment;
  const Vec3 a_beside = a_after - bodies.common(), b_beside = b_after - bodies.common();
  const Vec3 low = a.cwiseMin(b).cwiseMin(a_beside).cwiseMin(b_beside),
             high = a.cwiseMax(b).cwiseMax(a_beside).cwiseMax(b_beside);
  thread_local std::vector<int> near;
  Soonest soonest;
  for (int body = 0; body < bodies.count(); ++body) {
    if (!bodies.sheet(body)) continue;
    near.clear();
    bodies.tree(body).for_each_within(low, high, 0, [&](int t) { near.push_back(t); });
    bool was = false, is = false;
    for (const int t : near) {
      const Triangle& triangle = bodies.triangles(body)[at(t)];
      was = was || crosses(a, b, corners_of(bodies.before(body), triangle));
      is = is || crosses(a_after, b_after, corners_of(bodies.after(body), triangle));
    }
    if (was || !is) continue;
    for (const int t : near) {
      const Triangle& triangle = bodies.triangles(body)[at(t)];
      const Corners before = corners_of(bodies.before(body), triangle),
                    after = corners_of(bodies.after(body), triangle);
      for (int k = 0; k < 3; ++k) {
        const int m = (k + 1) % 3;
        const Vec3 &p = before[at(k)], &q = before[at(m)];
        soonest.look({PairKind::k_edge_edge,
                      {a, b, p, q},
                      {a_after - a, b_after - b, after[at(k)] - p, after[at(m)] - q},
                      {k, m, 0}},
                     body, t, before, after, 0);
      }
      for (const bool second : {false, true}) {
        const Vec3 &v = second ? b : a, goes = second ? Vec3(b_after - b) : Vec3(a_after - a);
        soonest.look({PairKind::k_vertex_face,
                      {v, before[0], before[1], before[2]},
                      {goes, after[0] - before[0], after[1] - before[1], after[2] - before[2]},
                      {0, 1, 2}},
                     body, t, before, after, second ? 1 : 0);
      }
    }
  }
  return soonest.found;
}

}  // namespace ft::inline solvers
