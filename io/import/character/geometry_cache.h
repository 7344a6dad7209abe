// A primary that is a geometry cache: faces, and the positions of every sample.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/hash.h"
#include "baker/core/mesh.h"

namespace ft::inline io {

/// A vertex that was, for some samples, where no body can have it: see stray_vertices.h.
struct StrayVertex {
  int vertex = 0;
  int first_sample = 0, last_sample = 0;  ///< without a break
  double distance = 0;                    ///< farthest from where it was put back to [file units]; if finite
  bool finite = true;
  bool mended = true;  ///< false: away for too long to be a slip; left as it is
};

struct GeometryCache {
  std::string format;  ///< "Alembic", "PC2", "MDD", "OBJ"
  Mesh mesh;           ///< faces; positions are those of the topology file
  int vertex_count = 0;
  std::vector<double> times;     ///< s, ascending, the first is 0
  std::vector<Vec3f> positions;  ///< sample after sample, file units and axes
  std::vector<std::string> notes;
  std::vector<StrayVertex> strays;  ///< by sample and vertex
  Hash128 content;
  std::span<const Vec3f> sample(std::size_t i) const {
    return {positions.data() + i * static_cast<std::size_t>(vertex_count), static_cast<std::size_t>(vertex_count)};
  }
};

}  // namespace ft::inline io
