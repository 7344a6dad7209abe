#include "baker/core/trajectory.h"

namespace ft {

std::vector<Triangle> solid_triangles(std::span<const Triangle> triangles, std::span<const int> part_of_vertex,
                                      std::span<const SurfacePart> parts) {
  std::vector<Triangle> out;
  for (const Triangle& t : triangles)
    if (!parts[at(part_of_vertex[at(t[0])])].sheet) out.push_back(t);
  return out;
}

}  // namespace ft
