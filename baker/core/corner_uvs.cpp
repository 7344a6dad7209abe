#include "baker/core/corner_uvs.h"

namespace ft {

std::vector<std::array<Vec2, 3>> corner_uvs(const Mesh& mesh, std::span<const Triangle> triangles) {
  std::vector<std::array<Vec2, 3>> out;
  if (mesh.uvs.empty() || mesh.face_uvs.size() != mesh.face_vertices.size()) return out;
  out.reserve(triangles.size());
  std::size_t begin = 0, next = 0;
  for (const int size : mesh.face_sizes) {
    for (int k = 0; k + 2 < size; ++k, ++next) {
      std::array<Vec2, 3> uv;
      for (std::size_t c = 0; c < 3; ++c) {
        std::size_t corner = begin;
        while (corner < begin + at(size) && mesh.face_vertices[corner] != triangles[next][c]) ++corner;
        const int index = corner < begin + at(size) ? mesh.face_uvs[corner] : -1;
        uv[c] = index >= 0 && at(index) < mesh.uvs.size() ? mesh.uvs[at(index)] : Vec2::Zero();
      }
      out.push_back(uv);
    }
    begin += at(size);
  }
  return out;
}

}  // namespace ft
