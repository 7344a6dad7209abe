#include "samples/tools/top.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "samples/tools/distance_grid.h"

namespace ft::garments {
namespace {

using Field = std::function<double(const Vec3&)>;

struct QuadMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<int, 4>> quads;  ///< the last corner is -1 in a triangle
};

int corner_count(const std::array<int, 4>& quad) {
  return quad[3] < 0 ? 3 : 4;
}

/// Naive surface nets of field = 0 over the cells of a box: one vertex per cell that the surface passes, one quad per
/// grid edge that it crosses. Quads at the border of the box, which miss a cell, are left out: that is the cut.
QuadMesh surface_nets(const Field& field, const Box& box, double cell) {
  std::array<int, 3> n;
  for (int k = 0; k < 3; ++k) n[at(k)] = static_cast<int>(std::lround(box.size()[k] / cell));
  const auto node = [&](int x, int y, int z) { return (box.lo + cell * Vec3(x, y, z)).eval(); };
  const auto node_index = [&](int x, int y, int z) { return at((z * (n[1] + 1) + y) * (n[0] + 1) + x); };
  std::vector<double> value(at((n[0] + 1) * (n[1] + 1) * (n[2] + 1)));
  for (int z = 0; z <= n[2]; ++z)
    for (int y = 0; y <= n[1]; ++y)
      for (int x = 0; x <= n[0]; ++x) value[node_index(x, y, z)] = field(node(x, y, z));
  QuadMesh mesh;
  std::vector<int> vertex(value.size(), -1);  // of the cell whose lowest node it is
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        Vec3 sum = Vec3::Zero();
        int count = 0;
        for (int axis = 0; axis < 3; ++axis)
          for (int corner = 0; corner < 4; ++corner) {
            std::array<int, 3> a{x, y, z};
            a[at((axis + 1) % 3)] += corner & 1;
            a[at((axis + 2) % 3)] += corner >> 1;
            std::array<int, 3> b = a;
            ++b[at(axis)];
            const double fa = value[node_index(a[0], a[1], a[2])], fb = value[node_index(b[0], b[1], b[2])];
            if ((fa < 0) == (fb < 0)) continue;
            sum += node(a[0], a[1], a[2]) + cell * fa / (fa - fb) * Vec3::Unit(axis);
            ++count;
          }
        if (count == 0) continue;
        vertex[node_index(x, y, z)] = static_cast<int>(mesh.positions.size());
        mesh.positions.push_back(sum / count);
      }
  for (int z = 0; z <= n[2]; ++z)
    for (int y = 0; y <= n[1]; ++y)
      for (int x = 0; x <= n[0]; ++x)
        for (int axis = 0; axis < 3; ++axis) {
          std::array<int, 3> a{x, y, z}, b{x, y, z};
          if (++b[at(axis)] > n[at(axis)]) continue;
          const bool in_a = value[node_index(a[0], a[1], a[2])] < 0, in_b = value[node_index(b[0], b[1], b[2])] < 0;
          if (in_a == in_b) continue;
          std::array<int, 4> quad{};
          bool whole = true;
          for (int k = 0; k < 4; ++k) {  // around the edge, counter-clockwise seen against the axis
            std::array<int, 3> c = a;
            if (k == 0 || k == 3) --c[at((axis + 1) % 3)];
            if (k == 0 || k == 1) --c[at((axis + 2) % 3)];
            whole = whole && *std::min_element(c.begin(), c.end()) >= 0;
            for (int d = 0; d < 3; ++d) whole = whole && c[at(d)] < n[at(d)];
            quad[at(k)] = whole ? vertex[node_index(c[0], c[1], c[2])] : -1;
          }
          if (!whole) continue;
          if (!in_a) std::swap(quad[1], quad[3]);
          mesh.quads.push_back(quad);
        }
  return mesh;
}

/// Keeps the piece with the most quads and drops vertices that no quad uses.
void keep_largest_piece(QuadMesh& mesh) {
  std::vector<int> root(mesh.positions.size());
  for (int k = 0; k < static_cast<int>(root.size()); ++k) root[at(k)] = k;
  const auto find = [&](int v) {
    while (root[at(v)] != v) v = root[at(v)] = root[at(root[at(v)])];
    return v;
  };
  for (const auto& quad : mesh.quads)
    for (int k = 1; k < corner_count(quad); ++k) root[at(find(quad[at(k)]))] = find(quad[0]);
  std::map<int, int> count;
  for (const auto& quad : mesh.quads) ++count[find(quad[0])];
  int largest = -1;
  for (const auto& [piece, quads] : count)
    if (largest < 0 || quads > count[largest]) largest = piece;
  QuadMesh kept;
  std::vector<int> number(mesh.positions.size(), -1);
  for (auto quad : mesh.quads) {
    if (find(quad[0]) != largest) continue;
    for (int k = 0; k < corner_count(quad); ++k) {
      int& v = quad[at(k)];
      if (number[at(v)] < 0) {
        number[at(v)] = static_cast<int>(kept.positions.size());
        kept.positions.push_back(mesh.positions[at(v)]);
      }
      v = number[at(v)];
    }
    kept.quads.push_back(quad);
  }
  mesh = std::move(kept);
}

/// A cut that slants through the grid leaves a staircase. Corners that only one quad uses are cut off (a triangle
/// stays), and quads with two such corners go.
void cut_stairs(QuadMesh& mesh) {
  for (bool again = true; again;) {
    again = false;
    std::vector<int> uses(mesh.positions.size(), 0);
    for (const auto& quad : mesh.quads)
      for (const int v : quad) ++uses[at(v)];
    again = std::erase_if(mesh.quads, [&](const auto& quad) {
              return std::count_if(quad.begin(), quad.end(), [&](int v) { return uses[at(v)] == 1; }) >= 2;
            }) > 0;
  }
  std::vector<int> uses(mesh.positions.size(), 0);
  for (const auto& quad : mesh.quads)
    for (const int v : quad) ++uses[at(v)];
  for (auto& quad : mesh.quads)
    for (int k = 0; k < 4; ++k)
      if (uses[at(quad[at(k)])] == 1) {
        quad = {quad[at((k + 1) % 4)], quad[at((k + 2) % 4)], quad[at((k + 3) % 4)], -1};
        break;
      }
}

Vec3 slope(const Field& field, const Vec3& p, double step) {
  Vec3 g;
  for (int k = 0; k < 3; ++k) g[k] = (field(p + step * Vec3::Unit(k)) - field(p - step * Vec3::Unit(k))) / (2 * step);
  return g;
}

/// Which plane of the cut a border vertex belongs to: the axis and where; axis -1 inside of the cloth.
struct Cut {
  int axis = -1;
  double place = 0;
};

/// Evens out the quads: every vertex to the middle of its neighbours, border vertices along their border and in their
/// plane, then back onto the surface.
void relax(QuadMesh& mesh, const Field& field, const std::vector<Cut>& planes, double cell, int rounds) {
  std::map<Edge, int> uses;
  for (const auto& q : mesh.quads)
    for (int k = 0, n = corner_count(q); k < n; ++k)
      ++uses[{std::min(q[at(k)], q[at((k + 1) % n)]), std::max(q[at(k)], q[at((k + 1) % n)])}];
  std::vector<std::vector<int>> inner(mesh.positions.size()), border(mesh.positions.size());
  for (const auto& [edge, count] : uses)
    for (int k = 0; k < 2; ++k) (count == 1 ? border : inner)[at(edge[at(k)])].push_back(edge[at(1 - k)]);
  std::vector<Cut> cut(mesh.positions.size());
  for (std::size_t v = 0; v < cut.size(); ++v) {
    if (border[v].empty()) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Cut& plane : planes) {
      const double d = std::abs(mesh.positions[v][plane.axis] - plane.place);
      if (d < nearest) nearest = d, cut[v] = plane;
    }
  }
  std::vector<Vec3> next(mesh.positions.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t v = 0; v < next.size(); ++v) {
      const std::vector<int>& around = border[v].empty() ? inner[v] : border[v];
      Vec3 middle = Vec3::Zero();
      for (const int w : around) middle += mesh.positions[at(w)];
      Vec3 p = 0.4 * mesh.positions[v] + 0.6 * middle / static_cast<double>(around.size());
      for (int step = 0; step < 3; ++step) {
        if (cut[v].axis >= 0) p[cut[v].axis] = cut[v].place;
        Vec3 g = slope(field, p, 0.25 * cell);
        if (cut[v].axis >= 0) g[cut[v].axis] = 0;
        if (g.squaredNorm() < 0.05) break;  // a flat place of the field says nothing
        Vec3 move = -field(p) / g.squaredNorm() * g;
        if (move.norm() > 0.5 * cell) move *= 0.5 * cell / move.norm();
        p += move;
      }
      next[v] = p;
    }
    mesh.positions = next;
  }
}

}  // namespace

Result<Mesh> make_top(const Body& body, const BodyShape& shape, const TopSettings& settings) {
  const double cell = settings.cell, margin = settings.distance + 3 * cell;
  const double middle = shape.waist_centre.x(), half = shape.chest_half_width + settings.sleeve;
  // Cells whose middles lie on the cuts, so that the border vertices are near their planes from the start.
  Box box;
  box.lo = Vec3(middle - half - 0.5 * cell, shape.waist + settings.hem - 0.5 * cell, shape.bounds.lo.z() - margin);
  // The cloth lies at its distance above the shoulders; a cut below that would take them away.
  box.hi = Vec3(middle + half, shape.neck_base + settings.distance + cell, shape.bounds.hi.z() + margin);
  for (int k = 0; k < 3; ++k) {
    const double cells = std::ceil(box.size()[k] / cell);
    if (!(cells > 2 && cells < 400))
      return input_error("the body gives a top no sensible size", "", "try another --waist or --cell");
    box.hi[k] = box.lo[k] + cells * cell;
  }
  Box wide = box;
  wide.inflate(margin);
  const DistanceGrid distance = make_distance_grid(body, wide, 0.5 * cell, margin + 2 * cell);
  // A little blur takes the crease out of the armpits.
  const Field field = [&](const Vec3& p) {
    double sum = 2 * distance.value(p);
    for (int k = 0; k < 3; ++k)
      sum += distance.value(p + 0.7 * cell * Vec3::Unit(k)) + distance.value(p - 0.7 * cell * Vec3::Unit(k));
    return sum / 8 - settings.distance;
  };
  QuadMesh net = surface_nets(field, box, cell);
  cut_stairs(net);
  keep_largest_piece(net);
  if (net.quads.size() < 100) return input_error("found no torso to put a top on", "", "try another --waist");
  const std::vector<Cut> planes = {{0, box.lo.x() + 0.5 * cell},
                                   {0, box.hi.x() - 0.5 * cell},
                                   {1, box.lo.y() + 0.5 * cell},
                                   {1, box.hi.y() - 0.5 * cell}};
  relax(net, field, planes, cell, 30);
  for (Vec3& p : net.positions)
    for (int step = 0; step < 8 && distance.value(p) < settings.clearance; ++step) {
      const Vec3 g = distance.gradient(p);
      p += (settings.clearance - distance.value(p)) / std::max(0.25, g.squaredNorm()) * g;
    }

  Mesh mesh;
  mesh.name = "top";
  mesh.positions = std::move(net.positions);
  VertexGroup shoulders{"shoulders", {}, {}};
  const double shoulder_height = box.hi.y() - 0.25 * (box.hi.y() - shape.waist);
  std::vector<char> on_shoulder(mesh.positions.size(), 0);
  for (const auto& quad : net.quads) {
    const int corners = corner_count(quad);
    mesh.face_sizes.push_back(corners);
    mesh.face_vertices.insert(mesh.face_vertices.end(), quad.begin(), quad.begin() + corners);
    const auto corner = [&](int k) { return mesh.positions[at(quad[at(k)])]; };
    const Vec3 normal = (corner(2) - corner(0)).cross(corner(corners - 1) - corner(1)).normalized();
    const Vec3& p = mesh.positions[at(quad[0])];
    if (normal.y() > 0.5 && p.y() > shoulder_height && std::abs(p.x() - middle) < shape.chest_half_width)
      for (int k = 0; k < corners; ++k) on_shoulder[at(quad[at(k)])] = 1;
  }
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (on_shoulder[at(v)]) shoulders.vertices.push_back(v), shoulders.weights.push_back(1);
  if (!shoulders.vertices.empty()) mesh.groups.push_back(std::move(shoulders));
  return mesh;
}

}  // namespace ft::garments
