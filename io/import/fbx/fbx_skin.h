// Skins of FBX meshes: clusters, weights, and which kind of skinning they ask for.
#pragma once

#include "io/import/character/character.h"
#include "io/import/fbx/fbx_scene.h"

namespace ft::inline io {

/// What was odd about skins, over all meshes.
struct FbxSkinNotes {
  double least = 1, most = 1;                      ///< sums of weights
  int unweighted = 0, bad = 0, lost_clusters = 0;  ///< vertices, weights, clusters
  int odd_modes = 0;                               ///< clusters that do not normalise, where sums are not 1
  int added_binds = 0;                             ///< clusters whose bind matrix had to be made
  int rigid_blends = 0;                            ///< vertices of rigid skins that several bones move
  std::vector<std::string> several;                ///< meshes with more than one skin
};

/// Where the file's bind pose has the nodes, by the id of their models.
using FbxBindPoses = std::unordered_map<std::int64_t, const FbxNode*>;
FbxBindPoses read_bind_poses(const FbxDocument& document);

/// Bones and weights of a mesh from the Skin deformer of its Geometry; nothing when it has none.
void read_fbx_skin(const FbxDocument& document, const FbxScene& scene, const FbxBindPoses& bind_poses,
                   std::span<const Mat4> globals, const FbxObject& geometry, CharacterMesh& mesh, FbxSkinNotes& notes);
void write_notes(const FbxSkinNotes& notes, Character& out);

}  // namespace ft::inline io
