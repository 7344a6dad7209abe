#include "io/shot/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "baker/core/check.h"
#include "baker/core/triangle_corners.h"

namespace ft::inline io {
namespace {

using Cell = std::array<long long, 3>;

Cell cell_of(const Vec3& p, double size) {
  Cell cell;
  // Far beyond any garment; keeps the cast defined for any finite input.
  for (int k = 0; k < 3; ++k) cell[at(k)] = static_cast<long long>(std::clamp(std::floor(p[k] / size), -4e18, 4e18));
  return cell;
}

}  // namespace

WeldedMesh weld(const Mesh& mesh, double distance) {
  CHECK(distance > 0);
  WeldedMesh out;
  out.mesh.name = mesh.name;
  std::map<Cell, std::vector<int>> kept_in;  // cells one distance wide: whatever is near is in this cell or a neighbour
  for (const Vec3& p : mesh.positions) {
    const Cell home = cell_of(p, distance);
    int joined = -1;
    for (long long dx = -1; dx <= 1; ++dx)
      for (long long dy = -1; dy <= 1; ++dy)
        for (long long dz = -1; dz <= 1; ++dz) {
          const auto found = kept_in.find({home[0] + dx, home[1] + dy, home[2] + dz});
          if (found == kept_in.end()) continue;
          for (const int k : found->second)
            if ((out.mesh.positions[at(k)] - p).squaredNorm() < distance * distance && (joined < 0 || k < joined))
              joined = k;
        }
    if (joined < 0) {
      joined = out.mesh.vertex_count();
      out.in_file.vertices.push_back(static_cast<int>(out.joined_of.size()));
      out.mesh.positions.push_back(p);
      kept_in[home].push_back(joined);
    }
    out.joined_of.push_back(joined);
  }

  out.mesh.uvs = mesh.uvs;
  int begin = 0;
  for (int f = 0; f < mesh.face_count(); begin += mesh.face_sizes[at(f)], ++f) {
    std::vector<int> vertices, corners;
    for (int corner = begin; corner < begin + mesh.face_sizes[at(f)]; ++corner) {
      const int v = out.joined_of[at(mesh.face_vertices[at(corner)])];
      if (std::find(vertices.begin(), vertices.end(), v) != vertices.end()) continue;
      vertices.push_back(v);
      corners.push_back(corner);
    }
    if (corners.size() < 3) continue;
    out.mesh.face_sizes.push_back(static_cast<int>(corners.size()));
    out.mesh.face_vertices.insert(out.mesh.face_vertices.end(), vertices.begin(), vertices.end());
    if (!mesh.face_uvs.empty())
      for (const int corner : corners) out.mesh.face_uvs.push_back(mesh.face_uvs[at(corner)]);
    out.in_file.corners.insert(out.in_file.corners.end(), corners.begin(), corners.end());
    out.in_file.faces.push_back(f);
  }

  for (std::size_t s = 0; s < mesh.stitches.size(); ++s) {
    Stitch stitch = mesh.stitches[s];
    stitch.vertex = out.joined_of[at(stitch.vertex)];
    for (int& v : stitch.edge) v = out.joined_of[at(v)];
    if (stitch.vertex == stitch.edge[0] || stitch.vertex == stitch.edge[1]) continue;
    out.mesh.stitches.push_back(stitch);
    out.in_file.stitches.push_back(static_cast<int>(s));
  }

  for (const VertexGroup& group : mesh.groups) {
    std::map<int, double> weights;  // of joined vertices the heavier weight counts
    for (std::size_t i = 0; i < group.vertices.size(); ++i) {
      double& weight = weights[out.joined_of[at(group.vertices[i])]];
      weight = std::max(weight, group.weights[i]);
    }
    VertexGroup joined_group{group.name, {}, {}};
    for (const auto& [vertex, weight] : weights)
      joined_group.vertices.push_back(vertex), joined_group.weights.push_back(weight);
    out.mesh.groups.push_back(std::move(joined_group));
  }
  return out;
}

Mesh with_triangles_of(const Mesh& file, const Mesh& simulated, const FileNumbers& in_file) {
  Mesh out = file;
  out.face_sizes.clear();
  out.face_vertices.clear();
  out.face_uvs.clear();
  for (const Triangle& triangle : triangle_corners(simulated)) {
    out.face_sizes.push_back(3);
    for (const int k : triangle) {
      const std::size_t corner = at(in_file.corner(k));
      out.face_vertices.push_back(file.face_vertices[corner]);
      if (!file.face_uvs.empty()) out.face_uvs.push_back(file.face_uvs[corner]);
    }
  }
  return out;
}

void spread_welded(std::span<const int> joined_of, std::span<const Vec3> joined, std::span<Vec3> file_order) {
  CHECK(joined_of.size() == file_order.size());
  for (std::size_t i = 0; i < joined_of.size(); ++i) file_order[i] = joined[at(joined_of[i])];
}

}  // namespace ft::inline io
