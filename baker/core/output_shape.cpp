#include "baker/core/output_shape.h"

#include <fmt/format.h>

#include <algorithm>

namespace ft {

std::string_view shape_name(OutputShape shape) {
  switch (shape) {
    case OutputShape::k_mesh: return "a mesh";
    case OutputShape::k_curves: return "curves";
    case OutputShape::k_points: return "points";
    case OutputShape::k_instances: return "instances";
    case OutputShape::k_grid: return "a grid";
  }
  return "?";
}

std::string_view shape_key(OutputShape shape) {
  return shape == OutputShape::k_mesh ? "mesh" : shape == OutputShape::k_grid ? "grid" : shape_name(shape);
}

std::optional<OutputShape> find_shape(std::string_view key) {
  for (const OutputShape shape : {OutputShape::k_mesh, OutputShape::k_curves, OutputShape::k_points,
                                  OutputShape::k_instances, OutputShape::k_grid})
    if (shape_key(shape) == key) return shape;
  return std::nullopt;
}

int SystemShape::element_count() const {
  switch (content.shape) {
    case OutputShape::k_curves: return static_cast<int>(curves.rest.size());
    case OutputShape::k_instances: return static_cast<int>(instances.ids.size());
    default: return 0;
  }
}

std::string fault_of_prototypes(const SystemShape& shape) {
  const InstanceSet& set = shape.instances;
  if (set.prototype_names.size() != shape.prototypes.size())
    return fmt::format("{} prototypes with {} meshes", set.prototype_names.size(), shape.prototypes.size());
  for (const int p : set.prototypes)
    if (p < 0 || at(p) >= shape.prototypes.size()) return fmt::format("there is no prototype {}", p);
  return {};
}

Mesh joined_meshes(std::string name, std::span<const Mesh> meshes) {
  Mesh out;
  out.name = std::move(name);
  const bool uvs = std::none_of(meshes.begin(), meshes.end(), [](const Mesh& m) { return m.uvs.empty(); });
  for (const Mesh& mesh : meshes) {
    const int first = out.vertex_count(), first_uv = static_cast<int>(out.uvs.size());
    VertexGroup& group = out.groups.emplace_back();
    group.name = mesh.name;
    for (int v = 0; v < mesh.vertex_count(); ++v) group.vertices.push_back(first + v);
    group.weights.assign(group.vertices.size(), 1.0);
    out.positions.insert(out.positions.end(), mesh.positions.begin(), mesh.positions.end());
    out.face_sizes.insert(out.face_sizes.end(), mesh.face_sizes.begin(), mesh.face_sizes.end());
    for (const int v : mesh.face_vertices) out.face_vertices.push_back(first + v);
    if (!uvs) continue;
    out.uvs.insert(out.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
    for (const int v : mesh.face_uvs) out.face_uvs.push_back(first_uv + v);
  }
  return out;
}

}  // namespace ft
