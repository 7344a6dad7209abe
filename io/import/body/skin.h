// The deforming surface of a character: vertices of the chosen meshes welded and flattened, with everything that moves
// them. Linear blend skinning as glTF 2.0 defines it (section 3.7.3.3), in double precision, or dual quaternions (see
// dual_quaternions.h); morph targets are added before.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/trajectory.h"
#include "io/import/character/character.h"

namespace ft::inline io {

struct VertexOrigin {
  int mesh = 0, vertex = 0;
};

struct Skin {
  Surface surface;
  std::vector<VertexOrigin> origins;  ///< the first file vertex of each
  std::vector<Vec3> base;             ///< mesh space

  /// Vertices move by globals[node] * inverse_bind, weighted.
  struct Binding {
    int node = 0;
    Mat4 inverse_bind = Mat4::Identity();
  };
  std::vector<Binding> bindings;
  std::vector<int> start, binding;  ///< rows of each vertex
  std::vector<double> weight;
  std::vector<double> dual_share;  ///< of each vertex, as CharacterMesh has it; empty: all linear

  struct Morph {
    int weight_index = 0;  ///< into the weights of all nodes (ClipPose::morph_start)
    std::vector<int> vertices;
    std::vector<Vec3> deltas;
  };
  std::vector<Morph> morphs;
};

/// Joins vertices that have the same position, weights and morphs (exporters split them at seams of texture and
/// normals) and drops triangles that have no area then, and vertices without triangles. Parts are not assigned yet.
Skin weld(const Character& character, const std::vector<int>& meshes, std::vector<std::string>& notes);

/// World positions: placement * (blend of globals * inverse binds) * (base + morphs).
void deform(const Skin& skin, const Mat4& placement, std::span<const Mat4> globals,
            std::span<const double> morph_weights, std::span<Vec3> positions);

/// Parts by dominant bone, small ones merged into their neighbours. Fills skin.surface.parts and part_of_vertex;
/// positions are those of the bind pose [m].
void assign_parts(const Character& character, std::span<const Vec3> positions, Skin& skin);

}  // namespace ft::inline io
