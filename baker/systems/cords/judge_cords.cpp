#include "baker/systems/cords/judge_cords.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "collision/check/crossings.h"
#include "collision/check/penetration.h"
#include "collision/geometry/pair_geometry.h"
#include "collision/geometry/triangle_tree.h"
#include "solvers/cords/tubes.h"

namespace ft::inline baker {
namespace {

constexpr int k_sides = CordTubes::k_sides;

double distance(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (edge_crosses_triangle(p, q, a, b, c)) return 0;
  return std::min({vertex_face_geometry(p, a, b, c).distance, vertex_face_geometry(q, a, b, c).distance,
                   edge_edge_geometry(p, q, a, b).distance, edge_edge_geometry(p, q, b, c).distance,
                   edge_edge_geometry(p, q, c, a).distance});
}

}  // namespace

Result<MiddleLines> middle_lines(const Mesh& tubes) {
  const auto refuse = [&] { return input_error(fmt::format("\"{}\" is no mesh of tubes", tubes.name)); };
  if (tubes.vertex_count() % k_sides != 0) return refuse();
  MiddleLines out;
  out.point_count = tubes.vertex_count() / k_sides;
  std::vector<Vec3> points;
  append_middle_points(tubes.positions, points);
  std::vector<bool> joined(at(out.point_count), false);  // to the next one
  for (std::size_t face = 0, corner = 0; face < tubes.face_sizes.size(); ++face) {
    const auto ring = [&](int k) { return tubes.face_vertices[corner + at(k)] / k_sides; };
    int first = ring(0), last = ring(0);
    for (int k = 1; k < tubes.face_sizes[face]; ++k) first = std::min(first, ring(k)), last = std::max(last, ring(k));
    if (last > first + 1) return refuse();
    if (last > first) joined[at(first)] = true;
    corner += at(tubes.face_sizes[face]);
  }
  for (int i = 0; i + 1 < out.point_count; ++i) {
    const double length = (points[at(i + 1)] - points[at(i)]).norm();
    if (!joined[at(i)] || !(length > 0)) continue;
    out.cords.edges.push_back({i, i + 1});
    out.cords.lengths.push_back(length);
  }
  return out;
}

void append_middle_points(std::span<const Vec3> vertices, std::vector<Vec3>& out) {
  for (std::size_t i = 0; i + k_sides <= vertices.size(); i += k_sides) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& x : vertices.subspan(i, k_sides)) sum += x;
    out.push_back(sum / k_sides);
  }
}

int vertex_of_point(int point) {
  return point * k_sides;
}

CordsAndBody judge_cords(std::span<const Edge> cords, std::span<const Vec3> points, std::span<const Vec3> surface,
                         std::span<const Triangle> triangles) {
  CordsAndBody out;
  const TriangleTree tree(surface, triangles);
  TriangleTree::Hit nearest;  // of all points: no cord is farther away
  for (const Vec3& p : points) tree.closest(p, surface, triangles, nearest);
  out.gap = std::sqrt(nearest.closest.squared_distance);
  for (const Edge& cord : cords) {
    const Vec3 &p = points[at(cord[0])], &q = points[at(cord[1])];
    const Vec3 reach = Vec3::Constant(out.gap);
    int crossings = 0;
    tree.for_each_near(TreeBox::around(p.cwiseMin(q) - reach, p.cwiseMax(q) + reach), [&](int t) {
      const auto& [a, b, c] = triangles[at(t)];
      const double apart = distance(p, q, surface[at(a)], surface[at(b)], surface[at(c)]);
      crossings += apart == 0;
      out.gap = std::min(out.gap, apart);
    });
    if (crossings > 0 && out.crossed < 0) out.crossed = cord[0];
    out.crossings += crossings;
  }
  for (const Penetration& p : penetrations(points, surface, triangles))
    if (p.depth > out.deepest) out.deepest = p.depth, out.inside = p.vertex;
  return out;
}

}  // namespace ft::inline baker
