#include "solvers/cloth/embed/coarse_garment.h"

#include <algorithm>
#include <map>
#include <set>

#include "baker/core/corner_uvs.h"
#include "collision/simplify/short_edges.h"

namespace ft::inline solvers {
namespace {

/// Of the contact distance, and of the typical edge: shorter edges are collapsed [1]. Of sheets with spots of
/// short edges of many sizes (dense_spots) a third strain over 10 % in some frame with 1/25 and 1/150; with 1/3 and
/// 1/25 so much of the cloth rides that where it folds riders cross, and are drawn in, as often.
constexpr double k_of_thickness = 1.0 / 5, k_of_edge = 1.0 / 40;

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

std::vector<char> pinned_or_sewn(const ClothGarment& garment) {
  std::vector<char> out(garment.mesh.positions.size(), 0);
  for (const ClothPin& pin : garment.pins)
    for (const int v : pin.vertices) out[at(v)] = 1;
  for (const Stitch& s : garment.mesh.stitches)
    for (const int v : {s.vertex, s.edge[0], s.edge[1]}) out[at(v)] = 1;
  return out;
}

/// What was drawn into a vertex that the pin does not hold has it held.
ClothPin on_coarse(const ClothPin& pin, const CoarsenedMesh& mesh) {
  ClothPin out = pin;
  out.vertices.clear();
  out.weights.clear();
  std::set<int> taken;
  for (const bool kept : {true, false})
    for (std::size_t k = 0; k < pin.vertices.size(); ++k) {
      const int v = mesh.into[at(pin.vertices[k])];
      if ((mesh.kept[at(v)] == pin.vertices[k]) != kept || (!kept && !taken.insert(v).second)) continue;
      if (kept) taken.insert(v);
      out.vertices.push_back(v);
      if (!pin.weights.empty()) out.weights.push_back(pin.weights[k]);
    }
  return out;
}

/// Where vertices were drawn together, one stitch of a vertex to an edge does, and none to itself.
std::vector<Stitch> on_coarse(std::span<const Stitch> stitches, const CoarsenedMesh& mesh) {
  std::vector<Stitch> out;
  std::set<std::pair<int, std::array<int, 2>>> taken;
  for (const Stitch& s : stitches) {
    const Stitch now{mesh.into[at(s.vertex)], {mesh.into[at(s.edge[0])], mesh.into[at(s.edge[1])]}, s.place, s.seam};
    if (now.vertex == now.edge[0] || now.vertex == now.edge[1]) continue;
    const auto is_kept = [&](int v) { return mesh.kept[at(mesh.into[at(v)])] == v; };
    const bool same = is_kept(s.vertex) && is_kept(s.edge[0]) && is_kept(s.edge[1]);
    if (!taken.insert({now.vertex, now.edge}).second && !same) continue;
    out.push_back(now);
  }
  return out;
}

CoarseGarment on_coarse(const ClothGarment& fine, CoarsenedMesh mesh) {
  CoarseGarment out{fine, {}, {}, {}};
  std::vector<Vec3> positions;
  for (const int v : mesh.kept) positions.push_back(fine.mesh.positions[at(v)]);
  out.garment.mesh = make_triangle_mesh(fine.mesh.name, std::move(positions), mesh.triangles);
  for (const auto& corners : mesh.uvs)
    for (const Vec2& uv : corners) {
      out.garment.mesh.face_uvs.push_back(static_cast<int>(out.garment.mesh.uvs.size()));
      out.garment.mesh.uvs.push_back(uv);
    }
  out.garment.mesh.stitches = on_coarse(fine.mesh.stitches, mesh);
  for (ClothPin& pin : out.garment.pins) pin = on_coarse(pin, mesh);
  for (const NamedMap& map : k_vertex_maps) {
    const std::vector<double>& values = fine.maps.*map.values;
    if (values.empty()) continue;
    std::vector<double>& left = out.garment.maps.*map.values;
    left.clear();
    for (const int v : mesh.kept) left.push_back(values[at(v)]);
  }
  out.kept = std::move(mesh.kept);
  out.places = std::move(mesh.places);
  out.into = std::move(mesh.into);
  return out;
}

double median_edge(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  std::vector<double> lengths;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) lengths.push_back((x[at(t[k])] - x[at(t[(k + 1) % 3])]).norm());
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

double thinnest(const ClothGarment& garment) {
  const std::vector<double>& map = garment.maps.thickness;
  return map.empty() ? garment.thickness : *std::min_element(map.begin(), map.end());
}

}  // namespace

CoarseGarment coarse_garment(const ClothGarment& fine, double factor) {
  const std::vector<Triangle> triangles = triangulate(fine.mesh);
  const auto uvs = corner_uvs(fine.mesh, triangles);
  const std::vector<int> groups = groups_by_holds(fine);
  CoarsenInput input{fine.mesh.positions, triangles, uvs, groups, factor};
  input.cut = fine.pattern_scale > 0;
  return on_coarse(fine, coarsen_mesh(input));
}

double shortest_edge(const ClothGarment& garment) {
  return std::min(k_of_thickness * thinnest(garment),
                  k_of_edge * median_edge(garment.mesh.positions, triangulate(garment.mesh)));
}

std::optional<CoarseGarment> without_short_edges(const ClothGarment& fine) {
  const std::vector<Triangle> triangles = triangulate(fine.mesh);
  ShortEdgesInput input;
  input.rest = fine.mesh.positions;
  input.triangles = triangles;
  input.shortest = k_of_thickness * thinnest(fine);
  if (!has_short_edges(input)) return {};  // nearly always, and the quickest to see
  input.shortest = shortest_edge(fine);
  if (!has_short_edges(input)) return {};
  const auto uvs = corner_uvs(fine.mesh, triangles);
  const std::vector<char> held = pinned_or_sewn(fine);
  input.uvs = uvs;
  input.pattern_scale = fine.pattern_scale;
  input.held = held;
  CoarsenedMesh mesh = collapse_short_edges(input);
  if (mesh.kept.size() == fine.mesh.positions.size()) return {};
  return on_coarse(fine, std::move(mesh));
}

}  // namespace ft::inline solvers
