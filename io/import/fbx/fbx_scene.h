// The models of an FBX file as the nodes of a character, and what its other readers need to know of that.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "io/import/character/character.h"
#include "io/import/fbx/fbx_clips.h"
#include "io/import/fbx/fbx_document.h"

namespace ft::inline io {

struct FbxScene {
  std::vector<const FbxObject*> models;  ///< of each node of the character that is a model
  std::unordered_map<std::int64_t, int> node_of_model;
  std::vector<FbxShapeChannel> shapes;  ///< one per use by a mesh

  /// -1 when the object is no model.
  int node_of(const FbxObject* model) const;
};

/// Fills out.nodes: parents first, the children of one model in the file's order, with their rest transforms. A circle
/// of parents is refused.
Result<FbxScene> read_fbx_nodes(const FbxDocument& document, Character& out);

/// Meshes with their geometric transforms, skins and blend shapes; fills scene.shapes and the rest weights of morphs.
Status read_fbx_meshes(const FbxDocument& document, FbxScene& scene, Character& out);

}  // namespace ft::inline io
