// One primitive of a mesh: positions, triangles of every mode, morph targets, and the weights of its joints, as they
// are before a node puts a skin to them.
#pragma once

#include <vector>

#include "io/import/gltf/gltf_file.h"

namespace ft::inline io::gltf {

/// What was odd, over all meshes; becomes notes.
struct MeshOddities {
  double least_sum = 1, most_sum = 1;  ///< of a vertex's weights
  int unweighted = 0, bad_weights = 0, lines = 0, without_positions = 0, cut_triangles = 0, unskinned = 0,
      lonely_sets = 0;
  std::vector<std::string> notes() const;
};

/// How much has been read so far, of what may be read.
struct MeshRoom {
  std::size_t vertices = 0;
  std::size_t morph_vertices = 0;
  std::size_t triangles = 0;
  /// Refuses n more vertices with so many morph targets if that is beyond the caps.
  Status take(std::size_t n, std::size_t targets);
  Status take_triangles(std::size_t n);
};

/// Influences of each vertex, by place in the skin's list of joints; rows ascend by joint and sum to 1, or are empty.
struct JointWeights {
  std::vector<int> start, joint;
  std::vector<double> weight;
  int most_joint = -1;
  bool empty() const { return start.empty(); }
};

struct Primitive {
  CharacterMesh mesh;  ///< without node and bones; no triangles: left out
  JointWeights weights;
};

/// The joints' weights are read only if `skinned`.
Result<Primitive> read_primitive(GltfFile& file, const Json& mesh, const Json& primitive, bool skinned, MeshRoom& room,
                                 MeshOddities& odd);

}  // namespace ft::inline io::gltf
