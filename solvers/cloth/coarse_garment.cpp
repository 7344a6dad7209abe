#include "solvers/cloth/coarse_garment.h"

#include <map>

#include "solvers/cloth/cloth_model.h"

namespace ft {
namespace {

/// Vertices that the same pins hold are a group: a belt stays on its line. Sewn ones stay: sides with vertices at
/// different places along their seam pucker it.
std::vector<int> groups_by_holds(const ClothGarment& garment) {
  std::vector<std::vector<std::size_t>> pins(garment.mesh.positions.size());
  for (std::size_t p = 0; p < garment.pins.size(); ++p)
    for (const int v : garment.pins[p].vertices) pins[at(v)].push_back(p);
  std::map<std::vector<std::size_t>, int> number{{{}, 0}};
  std::vector<int> out;
  for (const auto& held_by : pins)
    out.push_back(number.emplace(held_by, static_cast<int>(number.size())).first->second);
  for (const Stitch& s : garment.mesh.stitches)
    for (const int v : {s.vertex, s.edge[0], s.edge[1]}) out[at(v)] = k_group_stays;
  return out;
}

ClothPin on_kept(const ClothPin& pin, std::span<const int> number) {
  ClothPin out = pin;
  out.vertices.clear();
  out.weights.clear();
  for (std::size_t k = 0; k < pin.vertices.size(); ++k) {
    const int v = number[at(pin.vertices[k])];
    if (v < 0) continue;
    out.vertices.push_back(v);
    if (!pin.weights.empty()) out.weights.push_back(pin.weights[k]);
  }
  return out;
}

}  // namespace

CoarseGarment coarse_garment(const ClothGarment& fine, double factor) {
  const std::vector<Triangle> triangles = triangulate(fine.mesh);
  const auto uvs = corner_uvs(fine.mesh, triangles);
  const std::vector<int> groups = groups_by_holds(fine);
  CoarsenInput input{fine.mesh.positions, triangles, uvs, groups, factor};
  input.cut = fine.pattern_scale > 0;
  CoarsenedMesh coarse = coarsen_mesh(input);

  std::vector<Vec3> positions;
  std::vector<int> number(fine.mesh.positions.size(), -1);
  for (std::size_t i = 0; i < coarse.kept.size(); ++i) {
    positions.push_back(fine.mesh.positions[at(coarse.kept[i])]);
    number[at(coarse.kept[i])] = static_cast<int>(i);
  }
  CoarseGarment out{fine, std::move(coarse.kept), std::move(coarse.places)};
  out.garment.mesh = make_triangle_mesh(fine.mesh.name, std::move(positions), coarse.triangles);
  for (const auto& corners : coarse.uvs)
    for (const Vec2& uv : corners) {
      out.garment.mesh.face_uvs.push_back(static_cast<int>(out.garment.mesh.uvs.size()));
      out.garment.mesh.uvs.push_back(uv);
    }
  for (const Stitch& s : fine.mesh.stitches)
    out.garment.mesh.stitches.push_back(
        {number[at(s.vertex)], {number[at(s.edge[0])], number[at(s.edge[1])]}, s.place, s.seam});
  for (ClothPin& pin : out.garment.pins) pin = on_kept(pin, number);
  for (const NamedMap& map : k_vertex_maps) {
    const std::vector<double>& values = fine.maps.*map.values;
    if (values.empty()) continue;
    std::vector<double>& left = out.garment.maps.*map.values;
    left.clear();
    for (const int v : out.kept) left.push_back(values[at(v)]);
  }
  return out;
}

}  // namespace ft
