// A mesh in an archive. Names, scopes and interpretations are those of AbcGeom's PolyMesh schema, version 1. Careful:
// Alembic winds faces clockwise seen from outside (RenderMan), our meshes counter-clockwise.
#include <algorithm>

#include "io/cache/alembic_tree.h"
#include "io/cache/alembic_view.h"

namespace ft::inline io::alembic {

void reverse_faces(std::span<const int> face_sizes, std::vector<int>& corners) {
  auto face = corners.begin();
  for (const int size : face_sizes) {
    std::reverse(face, face + size);
    face += size;
  }
}

Layout mesh_layout(const CacheInfo& info, ogawa::Builder& out) {
  Layout layout{"AbcGeom_PolyMesh_v1", first_entries("vtx")};
  std::vector<Entry>& geometry = layout.geometry;
  if (info.content.changes) {
    geometry.push_back(channel_entry(k_face_corners, ".faceIndices", "", Pod::k_i32, 1, true));
    geometry.push_back(channel_entry(k_face_sizes, ".faceCounts", "", Pod::k_i32, 1, true));
    geometry.push_back(channel_entry(k_velocities, ".velocities", "interpretation=vector", Pod::k_f32, 3));
    std::vector<Entry> parameters;
    add_scalars(info.content.scalars, parameters);
    if (!parameters.empty()) geometry.push_back(compound_entry(".arbGeomParams", "", std::move(parameters)));
    return layout;
  }
  const Mesh& mesh = info.mesh;
  std::vector<int> corners = mesh.face_vertices;
  reverse_faces(mesh.face_sizes, corners);
  geometry.push_back(constant_entry(".faceIndices", "", Pod::k_i32, 1, append(out, corners), true));
  geometry.push_back(constant_entry(".faceCounts", "", Pod::k_i32, 1, append(out, mesh.face_sizes), true));
  geometry.push_back(channel_entry(k_velocities, ".velocities", "interpretation=vector", Pod::k_f32, 3));
  const Sample rest = append(out, flat(mesh.positions));
  if (!mesh.uvs.empty() && mesh.face_uvs.size() == mesh.face_vertices.size()) {
    std::vector<float> values;
    for (const Vec2& uv : mesh.uvs)
      for (int c = 0; c < 2; ++c) values.push_back(static_cast<float>(uv[c]));
    std::vector<int> uv_corners = mesh.face_uvs;
    reverse_faces(mesh.face_sizes, uv_corners);
    const std::string metadata = parameter_metadata("fvr", "vector", 2, "float32_t");
    const Sample vals = append(out, values), indices = append(out, uv_corners);
    geometry.push_back(compound_entry("uv", metadata,
                                      {constant_entry(".vals", metadata, Pod::k_f32, 2, vals),
                                       constant_entry(".indices", "", Pod::k_u32, 1, indices)}));
  }
  std::vector<Entry> parameters = {
      constant_entry("Pref", parameter_metadata("vtx", "point", 3, "float32_t"), Pod::k_f32, 3, rest)};
  add_scalars(info.content.scalars, parameters);
  geometry.push_back(compound_entry(".arbGeomParams", "", std::move(parameters)));
  return layout;
}

}  // namespace ft::inline io::alembic
