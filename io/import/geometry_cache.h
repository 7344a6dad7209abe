// Primaries that are a geometry cache: Alembic, PC2 and MDD with an OBJ for the faces, or a numbered sequence of OBJ
// files (one alone is a prop that stands still). Read whole, in the file's own vertex order.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/hash.h"
#include "baker/core/mesh.h"
#include "io/import/import.h"

namespace ft {

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

/// By the file's extension.
bool is_geometry_cache(const std::filesystem::path& file);

/// fps: samples per second (for MDD 0 means the file's own times). topology may be empty for OBJ; without it a PC2 or
/// MDD has no faces, which is an error unless faces_needed is false (info). With faces, vertices that stray for a few
/// samples are put back among their neighbours; points alone have to be finite.
Result<GeometryCache> read_geometry_cache(const std::filesystem::path& file, const std::filesystem::path& topology,
                                          double fps, bool faces_needed = true);

/// Files of a numbered sequence that `file` belongs to ("body_0001.obj", or "body_####.obj"), in order; one file alone
/// is itself.
Result<std::vector<std::filesystem::path>> numbered_sequence(const std::filesystem::path& file);

}  // namespace ft
