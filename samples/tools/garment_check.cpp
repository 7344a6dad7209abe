#include "samples/tools/garment_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "collision/check/crossings.h"
#include "collision/check/penetration.h"
#include "collision/geometry/winding_number.h"

namespace ft::garments {
namespace {

constexpr int k_rounds = 40;         ///< of pushes
constexpr double k_farthest = 0.08;  ///< that a way out of the body is looked for [m]
constexpr double k_step = 2e-3;      ///< by which what still crosses is pushed [m]
constexpr double k_carried = 0.85;   ///< of its neighbours' push that a vertex goes along with [1]
constexpr int k_carried_rings = 12;  ///< of neighbours

/// Garment and body as they are checked again and again.
struct Pair {
  CheckedSurface cloth, skin;
  std::optional<WindingTree> winding;  ///< of the body
  std::vector<Crossing> crossings;
  std::vector<Penetration> inside;

  Pair(std::span<const Triangle> triangles, const Body& body) : cloth(triangles), skin(body.triangles) {
    skin.move(body.positions);
    winding.emplace(skin.tree(), body.positions, body.triangles);
  }
  Fit look(std::span<const Vec3> garment) {
    cloth.move(garment);
    crossings = crossings_between(cloth, skin);
    inside = penetrations(garment, skin, 0);
    const std::vector<Crossing> own = crossings_within(cloth);
    Fit fit;
    fit.crossings = static_cast<int>(crossings.size());
    fit.own_crossings = static_cast<int>(own.size());
    fit.inside = static_cast<int>(inside.size());
    fit.gap = std::numeric_limits<double>::infinity();
    std::vector<char> is_inside(garment.size(), 0);
    for (const Penetration& p : inside) {
      is_inside[at(p.vertex)] = 1;
      if (p.depth > fit.depth) fit.depth = p.depth, fit.worst = p.vertex;
    }
    int nearest = -1;
    for (int v = 0; v < static_cast<int>(garment.size()); ++v)
      if (const double d = to_body(garment[at(v)]).norm(); !is_inside[at(v)] && d < fit.gap) fit.gap = d, nearest = v;
    if (fit.worst < 0 && !crossings.empty())
      fit.worst = crossings[0].edge_of_first ? crossings[0].edge[0] : crossings[0].triangle[0];
    if (fit.worst < 0 && !own.empty()) fit.worst = own[0].edge[0];
    if (fit.worst < 0) fit.worst = nearest;
    return fit;
  }
  /// From a point to the nearest of the body.
  Vec3 to_body(const Vec3& p) const {
    TriangleTree::Hit hit;
    skin.tree().closest(p, skin.positions(), skin.triangles(), hit);
    return hit.triangle < 0 ? Vec3::Constant(std::numeric_limits<double>::infinity()) : Vec3(hit.closest.point - p);
  }
};

/// The shorter way out of the body along the garment's normal or against it, and `clearance` more. The nearest triangle
/// of the body would not do: it may be a wall within, where shells overlap.
Vec3 way_out(const Pair& pair, const Vec3& p, const Vec3& normal, double clearance) {
  for (double t = k_step; t < k_farthest; t += k_step)
    for (const double side : {1.0, -1.0})
      if (!pair.winding->is_inside(p + side * t * normal)) return side * (t + clearance) * normal;
  return Vec3::Zero();
}

/// What each vertex has to move to be `clearance` outside. normals: of the body.
std::vector<Vec3> needed_moves(const Pair& pair, std::span<const Vec3> garment, std::span<const Vec3> normals,
                               double clearance) {
  const std::vector<Vec3> outwards = vertex_normals(garment, pair.cloth.triangles());
  std::vector<Vec3> move(garment.size(), Vec3::Zero());
  std::vector<char> is_inside(garment.size(), 0);
  for (const Penetration& p : pair.inside) is_inside[at(p.vertex)] = 1;
  for (std::size_t v = 0; v < garment.size(); ++v) {
    if (is_inside[v]) {
      move[v] = way_out(pair, garment[v], outwards[v], clearance);
      continue;
    }
    const Vec3 to = pair.to_body(garment[v]);
    const double d = to.norm();
    if (d > 0 && d < clearance) move[v] = (d - clearance) / d * to;
  }
  // A finger through a face, or an edge through a fold of the body: the vertices about it may be far enough away.
  const auto push = [&](int v, const Vec3& normal) {
    if (move[at(v)].squaredNorm() < k_step * k_step) move[at(v)] += k_step * normal;
  };
  for (const Crossing& c : pair.crossings) {
    const Vec3 normal = c.edge_of_first
                            ? Vec3(normals[at(c.triangle[0])] + normals[at(c.triangle[1])] + normals[at(c.triangle[2])])
                            : Vec3(normals[at(c.edge[0])] + normals[at(c.edge[1])]);
    if (!(normal.squaredNorm() > 0)) continue;
    if (c.edge_of_first)
      for (const int v : c.edge) push(v, normal.normalized());
    else
      for (const int v : c.triangle) push(v, normal.normalized());
  }
  return move;
}

}  // namespace

std::string Fit::text() const {
  std::string out;
  const auto add = [&](const std::string& part) { out += (out.empty() ? "" : ", ") + part; };
  if (crossings > 0) add(fmt::format("{} crossings with the body", crossings));
  if (inside > 0) add(fmt::format("{} vertices up to {:.1f} mm inside it", inside, 1e3 * depth));
  if (own_crossings > 0) add(fmt::format("{} crossings with itself", own_crossings));
  return out;
}

Fit fit_of(std::span<const Vec3> garment, std::span<const Triangle> triangles, const Body& body) {
  return Pair(triangles, body).look(garment);
}

Fit move_out(std::vector<Vec3>& garment, std::span<const Triangle> triangles, const Body& body, double clearance,
             double least_gap) {
  Pair pair(triangles, body);
  Fit fit = pair.look(garment);
  const std::vector<Edge> edges = unique_edges(triangles);
  const std::vector<Vec3> normals = vertex_normals(body.positions, body.triangles);
  for (int round = 0; round < k_rounds && !(fit.clear() && fit.gap >= least_gap); ++round) {
    std::vector<Vec3> move = needed_moves(pair, garment, normals, clearance);
    for (int ring = 0; ring < k_carried_rings; ++ring) {
      const std::vector<Vec3> before = move;
      for (const Edge& e : edges)
        for (int k = 0; k < 2; ++k) {
          const Vec3 carried = k_carried * before[at(e[at(1 - k)])];
          if (carried.squaredNorm() > move[at(e[at(k)])].squaredNorm()) move[at(e[at(k)])] = carried;
        }
    }
    for (std::size_t v = 0; v < garment.size(); ++v) garment[v] += move[v];
    fit = pair.look(garment);
  }
  return fit;
}

ShapeQuality shape_quality(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  std::vector<double> edges, angles;
  for (const Edge& e : unique_edges(triangles)) edges.push_back((positions[at(e[0])] - positions[at(e[1])]).norm());
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = positions[at(t[at((k + 1) % 3)])] - positions[at(t[at(k)])],
                 v = positions[at(t[at((k + 2) % 3)])] - positions[at(t[at(k)])];
      angles.push_back(std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / std::numbers::pi);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(angles.begin(), angles.end());
  if (edges.empty()) return {};
  return {edges.front(), edges[edges.size() / 2], edges.back(), angles.front(), angles[angles.size() / 100]};
}

}  // namespace ft::garments
