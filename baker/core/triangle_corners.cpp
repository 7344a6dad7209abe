#include "baker/core/triangle_corners.h"

namespace ft {

std::vector<Triangle> triangle_corners(const Mesh& mesh) {
  std::vector<Triangle> out;
  out.reserve(mesh.face_sizes.size());
  int begin = 0;
  for (const int size : mesh.face_sizes) {
    const auto p = [&](int k) -> const Vec3& { return mesh.positions[at(mesh.face_vertices[at(begin + k)])]; };
    // Equal diagonals (a regular grid) always split the same way: the strict comparison decides.
    if (size == 4 && (p(3) - p(1)).squaredNorm() < (p(2) - p(0)).squaredNorm()) {
      out.push_back({begin, begin + 1, begin + 3});
      out.push_back({begin + 1, begin + 2, begin + 3});
    } else {
      for (int k = 1; k + 1 < size; ++k) out.push_back({begin, begin + k, begin + k + 1});
    }
    begin += size;
  }
  return out;
}

}  // namespace ft
