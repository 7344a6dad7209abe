// Triangles and masses; hinges and curvature are in cloth_topology_bending.cpp.
#include "solvers/energies/cloth_topology.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "solvers/energies/caps.h"
#include "solvers/energies/cloth_topology_bending.h"

namespace ft::inline solvers {
namespace {

/// A triangle lower than this share of its longest edge carries nothing.
constexpr double k_flattest = 1e-6;
/// Below this a projected direction is noise [1].
constexpr double k_lying = 0.1;

/// Direction of growing v (warp) in the plane of the triangle; zero when the uvs do not tell.
Vec3 warp_from_uvs(const Vec3& e1, const Vec3& e2, const std::array<Vec2, 3>& uv) {
  const Vec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
  const double det = d1.x() * d2.y() - d1.y() * d2.x();
  const double size = std::max(d1.squaredNorm(), d2.squaredNorm());
  if (!std::isfinite(det) || std::abs(det) <= 1e-9 * size) return Vec3::Zero();
  return (e2 * d1.x() - e1 * d2.x()) / det;
}

Vec3 warp_from_shape(const Vec3& normal) {
  for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)}) {
    const Vec3 projected = axis - normal * normal.dot(axis);
    if (projected.norm() > k_lying) return projected;
  }
  return Vec3::Zero();
}

/// Lengths as on the cutting table; material axes are those of the pattern.
void cut_from_pattern(const std::array<Vec2, 3>& uv, double scale, std::size_t t, ClothTopology& out) {
  const Vec2 e1 = scale * (uv[1] - uv[0]), e2 = scale * (uv[2] - uv[0]);
  const double det = e1.x() * e2.y() - e2.x() * e1.y();  // below 0 where a panel is mirrored
  const double longest2 = std::max({e1.squaredNorm(), e2.squaredNorm(), (e2 - e1).squaredNorm()});
  if (!(std::abs(det) > k_flattest * longest2) || !(std::abs(det) > 1e-14)) return;
  out.rest_inverse[t] = {e2.y() / det, -e2.x() / det, -e1.y() / det, e1.x() / det};
  out.rest_area[t] = 0.5 * std::abs(det);
}

/// Lengths as they are at rest; uv: null without any.
void cut_from_rest(const std::array<Vec2, 3>* uv, std::size_t t, ClothTopology& out) {
  const Triangle& tri = out.triangles[t];
  const Vec3 e1 = out.rest[at(tri[1])] - out.rest[at(tri[0])], e2 = out.rest[at(tri[2])] - out.rest[at(tri[0])];
  const Vec3 n = e1.cross(e2);
  const double area2 = n.norm();
  const double longest2 = std::max({e1.squaredNorm(), e2.squaredNorm(), (e2 - e1).squaredNorm()});
  if (!(area2 > k_flattest * longest2) || !(area2 > 1e-14)) return;
  const Vec3 normal = n / area2;
  Vec3 axis2 = uv == nullptr ? Vec3::Zero() : warp_from_uvs(e1, e2, *uv);
  if (!(axis2.norm() > 0) || !axis2.allFinite()) axis2 = warp_from_shape(normal);
  axis2.normalize();
  const Vec3 axis1 = axis2.cross(normal);
  const double a = e1.dot(axis1), b = e2.dot(axis1), c = e1.dot(axis2), d = e2.dot(axis2);
  const double det = a * d - b * c;  // = area2
  out.rest_inverse[t] = {d / det, -b / det, -c / det, a / det};
  out.rest_area[t] = 0.5 * area2;
}

/// Shape of a triangle at rest.
void measure(std::size_t t, const std::array<Vec2, 3>* uv, ClothTopology& out) {
  out.rest_inverse[t] = {0, 0, 0, 0};
  out.rest_area[t] = 0;
  const double scale = uv == nullptr ? 0 : out.pieces[at(out.triangle_piece[t])].pattern_scale;
  if (scale > 0)
    cut_from_pattern(*uv, scale, t, out);
  else
    cut_from_rest(uv, t, out);
}

void weigh(std::size_t t, ClothTopology& out) {
  const ClothPiece& piece = out.pieces[at(out.triangle_piece[t])];
  const std::vector<double>& map = piece.maps.mass_per_area;
  for (const int v : out.triangles[t]) {
    const double density = map.empty() ? piece.fabric.mass_per_area : map[at(v - piece.first_vertex)];
    out.mass[at(v)] += density * out.rest_area[t] / 3;
  }
}

}  // namespace

double ClothTopology::factor(std::size_t t, std::vector<double> VertexMaps::*map) const {
  const ClothPiece& piece = pieces[at(triangle_piece[t])];
  const std::vector<double>& values = piece.maps.*map;
  if (values.empty()) return 1;
  const auto value = [&](std::size_t corner) { return values[at(triangles[t][corner] - piece.first_vertex)]; };
  return value(0) + ((value(1) - value(0)) + (value(2) - value(0))) / 3;
}

double rest_length(const ClothTopology& topology, std::size_t triangle, std::size_t corner) {
  const auto& r = topology.rest_inverse[triangle];
  const double det = r[0] * r[3] - r[1] * r[2];
  CHECK(det != 0 && corner < 3);
  const Vec2 e1 = Vec2(r[3], -r[2]) / det, e2 = Vec2(-r[1], r[0]) / det;
  return corner == 0 ? (e2 - e1).norm() : corner == 1 ? e2.norm() : e1.norm();
}

double hinge_angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
  const Vec3 e = x1 - x0;
  const Vec3 n1 = e.cross(x2 - x0), n2 = (x3 - x0).cross(e);
  const double length = e.norm();
  if (!(length > 0) || !(n1.squaredNorm() > 0) || !(n2.squaredNorm() > 0)) return 0;
  return std::atan2(n1.cross(n2).dot(e) / length, n1.dot(n2));
}

ClothTopology make_cloth_topology(std::span<const Vec3> rest, std::span<const Triangle> triangles,
                                  std::span<const ClothPiece> pieces,
                                  std::span<const std::array<Vec2, 3>> triangle_uvs) {
  CHECK(triangle_uvs.empty() || triangle_uvs.size() == triangles.size());
  CHECK(!pieces.empty());
  ClothTopology out;
  out.vertex_count = static_cast<int>(rest.size());
  out.rest.assign(rest.begin(), rest.end());
  out.triangles.assign(triangles.begin(), triangles.end());
  out.pieces.assign(pieces.begin(), pieces.end());
  out.mass.assign(rest.size(), 0.0);
  std::vector<int> piece_of(rest.size(), -1);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    CHECK(pieces[p].first_vertex >= 0 && pieces[p].first_vertex + pieces[p].vertex_count <= out.vertex_count);
    for (const NamedMap& map : k_vertex_maps) {
      const std::vector<double>& values = pieces[p].maps.*map.values;
      CHECK(values.empty() || values.size() == at(pieces[p].vertex_count));
    }
    std::fill_n(piece_of.begin() + pieces[p].first_vertex, pieces[p].vertex_count, static_cast<int>(p));
  }

  const std::size_t count = triangles.size();
  out.triangle_piece.resize(count);
  out.rest_area.assign(count, 0.0);
  out.rest_inverse.assign(count, {0, 0, 0, 0});
  std::vector<std::array<Vec2, 3>> uvs(triangle_uvs.begin(), triangle_uvs.end());
  for (std::size_t t = 0; t < count; ++t) {
    for (const int v : triangles[t]) CHECK(v >= 0 && v < out.vertex_count);
    out.triangle_piece[t] = piece_of[at(triangles[t][0])];
    CHECK(out.triangle_piece[t] >= 0);
  }
  const auto measure_one = [&](std::size_t t) { measure(t, uvs.empty() ? nullptr : &uvs[t], out); };
  for (std::size_t t = 0; t < count; ++t) measure_one(t);
  flip_caps(out, uvs, measure_one);
  for (std::size_t t = 0; t < count; ++t) weigh(t, out);
  add_hinges(out);
  add_bend_elements(out);
  return out;
}

}  // namespace ft::inline solvers
