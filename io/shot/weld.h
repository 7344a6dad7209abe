// Joins vertices that lie at one place, for garments whose seams were modelled as separate borders. The simulation runs
// on the joined mesh; caches are written in the file's own vertex order through `joined_of`, and messages speak of
// the file's numbers through `in_file`.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "io/shot/file_numbers.h"

namespace ft::inline io {

struct WeldedMesh {
  Mesh mesh;
  std::vector<int> joined_of;  ///< per vertex of the file: its vertex in `mesh`
  FileNumbers in_file;
};

/// Vertices nearer than `distance` [m, > 0] to an earlier kept one become that one, first come, first kept; their order
/// stays. Faces that lose their area by it (fewer than three different corners) are dropped, uvs are kept per corner;
/// stitches that it closes are dropped.
WeldedMesh weld(const Mesh& mesh, double distance);

/// The file's vertices under the triangles of triangulate(simulated), which is the mesh itself or what weld() made of
/// it; uvs, groups and stitches stay.
Mesh with_triangles_of(const Mesh& file, const Mesh& simulated, const FileNumbers& in_file);

/// Positions of the joined mesh, handed back to all vertices of the file.
void spread_welded(std::span<const int> joined_of, std::span<const Vec3> joined, std::span<Vec3> file_order);

}  // namespace ft::inline io
