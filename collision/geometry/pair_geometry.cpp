// The common case is a foot point well inside a well-shaped feature: then the normal of the feature decides and the
// distance is measured along it, which is exact to rounding even at a millionth of the edge length. On the boundary the
// answer is the foot point on one edge.
//
// Slim features (small angles, parallel edges) compare all candidates, those on the boundary and the interior one if
// there is any, by their measured distance and take the nearest. There a cross product is wrong by 1 / sin(angle) in
// every direction, also along the feature; two orthogonal directions found one after the other are wrong in the
// harmless direction only, so the interior candidate is found with them.
#include "collision/geometry/pair_geometry.h"

#include <algorithm>
#include <cmath>

namespace ft::inline collision {
namespace {

/// Features with a smaller sin^2 of the angle between two edges are slim.
constexpr double k_well_shaped = 1e-4;

struct FootPoint {
  double t;        ///< parameter along the segment, in [0, 1]
  Vec3 offset;     ///< from the foot point to the point
  double squared;  ///< its squared length
};

/// Of the point that lies from away from the segment's start. An edge without length is its start.
inline FootPoint segment_foot(const Vec3& from, const Vec3& edge, double edge_squared) {
  FootPoint f;
  f.t = edge_squared > 0 ? std::clamp(from.dot(edge) / edge_squared, 0.0, 1.0) : 0.0;
  f.offset = f.t < 1 ? Vec3(from - f.t * edge) : Vec3(from - edge);
  // The last bits of a long edge are many of a short offset: square it again, or its direction tilts along the edge.
  if (f.t > 0 && f.t < 1) f.offset -= (f.offset.dot(edge) / edge_squared) * edge;
  f.squared = f.offset.squaredNorm();
  return f;
}

inline void set_offset(PairGeometry& g, const Vec3& offset, double squared) {
  if (squared > 1e-290) {
    g.distance = std::sqrt(squared);
    g.normal = offset / g.distance;
  } else {  // squares of lengths below 1e-145 are lost: scale first
    const double largest = offset.cwiseAbs().maxCoeff();
    if (!(largest > 0)) return;
    const Vec3 scaled = offset / largest;
    const double length = scaled.norm();
    g.distance = largest * length;
    g.normal = scaled / length;
  }
}

/// Solves u e + v f = r as well as it can be done (least squares), e not shorter than f. False when e and f are
/// parallel.
inline bool solve_slim(const Vec3& e, const Vec3& f, const Vec3& r, double& u, double& v) {
  const double ee = e.squaredNorm();
  if (!(ee > 0)) return false;
  const double along = f.dot(e) / ee;
  Vec3 across = f - along * e;
  across -= (across.dot(e) / ee) * e;  // twice is enough
  const double cc = across.squaredNorm();
  if (!(cc > 0)) return false;
  v = r.dot(across) / cc;
  u = r.dot(e) / ee - v * (f.dot(e) / ee);
  return std::isfinite(u) && std::isfinite(v);
}

/// Distance along a normal that is not unit; side is its product with the offset.
inline void set_along(PairGeometry& g, const Vec3& normal, double normal_squared, double side) {
  const double length = std::sqrt(normal_squared);
  g.distance = std::abs(side) / length;
  if (side != 0) g.normal = normal * ((side > 0 ? 1.0 : -1.0) / length);
}

/// A face with a small angle at a (or a flat one there), or without area.
PairGeometry slim_vertex_face(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm();

  PairGeometry g;
  g.weight[0] = 1;
  double v = 0, w = 0;
  const Vec3 bc = c - b, bp = p - b;
  const FootPoint on_ab = segment_foot(ap, ab, ab2);
  const FootPoint on_ac = segment_foot(ap, ac, ac2);
  const FootPoint on_bc = segment_foot(bp, bc, bc.squaredNorm());
  const FootPoint* best = &on_ab;
  g.weight = {1, -(1 - on_ab.t), -on_ab.t, 0};
  if (on_ac.squared < best->squared) {
    best = &on_ac;
    g.weight = {1, -(1 - on_ac.t), 0, -on_ac.t};
  }
  if (on_bc.squared < best->squared) {
    best = &on_bc;
    g.weight = {1, 0, -(1 - on_bc.t), -on_bc.t};
  }
  const bool found = ab2 >= ac2 ? solve_slim(ab, ac, ap, v, w) : solve_slim(ac, ab, ap, w, v);
  if (found && v > 0 && w > 0 && v + w < 1) {
    const Vec3 offset = ap - v * ab - w * ac;
    const double squared = offset.squaredNorm();
    if (squared < best->squared) {
      g.weight = {1, -(1 - v - w), -v, -w};
      g.interior = true;
      set_offset(g, offset, squared);
      return g;
    }
  }
  set_offset(g, best->offset, best->squared);
  return g;
}

/// Edges that are nearly parallel, or without length.
PairGeometry slim_edge_edge(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const Vec3 da = a1 - a0, db = b1 - b0, r = a0 - b0;  // offset(s, t) = r + s da - t db
  const double aa = da.squaredNorm(), bb = db.squaredNorm();

  PairGeometry g;
  double s = 0, t = 0;
  // A closest pair that is not inside both edges has an end point of one of them.
  const FootPoint of_a0 = segment_foot(r, db, bb);
  const FootPoint of_a1 = segment_foot(a1 - b0, db, bb);
  const FootPoint of_b0 = segment_foot(-r, da, aa);
  const FootPoint of_b1 = segment_foot(b1 - a0, da, aa);
  Vec3 offset = of_a0.offset;
  double squared = of_a0.squared;
  g.weight = {1, 0, -(1 - of_a0.t), -of_a0.t};
  if (of_a1.squared < squared) {
    squared = of_a1.squared;
    offset = of_a1.offset;
    g.weight = {0, 1, -(1 - of_a1.t), -of_a1.t};
  }
  if (of_b0.squared < squared) {
    squared = of_b0.squared;
    offset = -of_b0.offset;
    g.weight = {1 - of_b0.t, of_b0.t, -1, 0};
  }
  if (of_b1.squared < squared) {
    squared = of_b1.squared;
    offset = -of_b1.offset;
    g.weight = {1 - of_b1.t, of_b1.t, 0, -1};
  }
  // -r = s da - t db
  const bool found = aa >= bb ? solve_slim(da, -db, -r, s, t) : solve_slim(-db, da, -r, t, s);
  if (found && s > 0 && s < 1 && t > 0 && t < 1) {
    const Vec3 within = r + s * da - t * db;
    if (within.squaredNorm() < squared) {
      squared = within.squaredNorm();
      offset = within;
      g.weight = {1 - s, s, -(1 - t), -t};
      g.interior = true;
    }
  }
  set_offset(g, offset, squared);
  return g;
}

}  // namespace

PairGeometry vertex_face_geometry(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm(), abac = ab.dot(ac);
  const double det = ab2 * ac2 - abac * abac;  // |ab x ac|^2
  if (!(det > k_well_shaped * ab2 * ac2)) return slim_vertex_face(p, a, b, c);

  // Regions of the plane after Ericson 2005, 5.1.5; d1..d6 are his.
  PairGeometry g;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  const double v = ac2 * d1 - abac * d2, w = ab2 * d2 - abac * d1, u = det - v - w;  // barycentric, times det
  if (u > 0 && v > 0 && w > 0) {
    const Vec3 n = ab.cross(ac);
    set_along(g, n, n.squaredNorm(), ap.dot(n));
    g.weight = {1, -u / det, -v / det, -w / det};
    g.interior = true;
    return g;
  }
  const double d3 = d1 - ab2, d4 = d2 - abac, d5 = d1 - abac, d6 = d2 - ac2;
  FootPoint f;
  if (w <= 0 && d1 >= 0 && d3 <= 0) {
    f = segment_foot(ap, ab, ab2);
    g.weight = {1, -(1 - f.t), -f.t, 0};
  } else if (v <= 0 && d2 >= 0 && d6 <= 0) {
    f = segment_foot(ap, ac, ac2);
    g.weight = {1, -(1 - f.t), 0, -f.t};
  } else if (u <= 0 && d4 >= d3 && d5 >= d6) {
    const Vec3 bc = c - b;
    f = segment_foot(p - b, bc, bc.squaredNorm());
    g.weight = {1, 0, -(1 - f.t), -f.t};
  } else {
    const bool at_b = d3 >= 0 && d4 <= d3, at_c = !at_b && d6 >= 0 && d5 <= d6;
    f.offset = at_b ? Vec3(p - b) : at_c ? Vec3(p - c) : ap;
    f.squared = f.offset.squaredNorm();
    g.weight = {1, at_b || at_c ? 0.0 : -1.0, at_b ? -1.0 : 0.0, at_c ? -1.0 : 0.0};
  }
  set_offset(g, f.offset, f.squared);
  return g;
}

PairGeometry edge_edge_geometry(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const Vec3 da = a1 - a0, db = b1 - b0, r = a0 - b0;  // offset(s, t) = r + s da - t db
  const double aa = da.squaredNorm(), bb = db.squaredNorm(), ab = da.dot(db);
  const double det = aa * bb - ab * ab;  // |da x db|^2
  if (!(det > k_well_shaped * aa * bb)) return slim_edge_edge(a0, a1, b0, b1);

  PairGeometry g;
  const double ra = r.dot(da), rb = r.dot(db);
  const double s_det = ab * rb - bb * ra;
  double s = s_det / det;
  const double t_free = (aa * rb - ab * ra) / det;
  if (s > 0 && s < 1 && t_free > 0 && t_free < 1) {
    const Vec3 n = da.cross(db);
    set_along(g, n, n.squaredNorm(), r.dot(n));
    g.weight = {1 - s, s, -(1 - t_free), -t_free};
    g.interior = true;
    return g;
  }
  // Ericson 2005, 5.1.9: clamp s, take the nearest t, clamp it, take the nearest s. The last step is a foot point.
  s = std::clamp(s, 0.0, 1.0);
  const double t_near = (rb + s * ab) / bb;
  if (t_near > 0 && t_near < 1 && (s == 0 || s == 1)) {
    const FootPoint f = segment_foot(s == 0 ? r : Vec3(a1 - b0), db, bb);
    g.weight = {1 - s, s, -(1 - f.t), -f.t};
    set_offset(g, f.offset, f.squared);
  } else {
    const double t = t_near < 0.5 ? 0.0 : 1.0;
    const FootPoint f = segment_foot(t == 0 ? Vec3(-r) : Vec3(b1 - a0), da, aa);
    g.weight = {1 - f.t, f.t, -(1 - t), -t};
    set_offset(g, -f.offset, f.squared);
  }
  return g;
}

double separation(PairKind kind, const std::array<Vec3, 4>& x, const PairGeometry& geometry) {
  const Vec3& n = geometry.normal;
  const double x1 = n.dot(x[1] - x[0]), x2 = n.dot(x[2] - x[0]), x3 = n.dot(x[3] - x[0]);
  if (kind == PairKind::k_vertex_face) return -std::max({x1, x2, x3});
  return std::min(0.0, x1) - std::max(x2, x3);
}

}  // namespace ft::inline collision
