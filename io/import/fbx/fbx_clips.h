// AnimationStack, AnimationLayer, AnimationCurveNode, AnimationCurve -> clips, exactly as the file animates: the curves
// go into the clip as they are.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/import/character/character.h"
#include "io/import/fbx/fbx_document.h"

namespace ft::inline io {

/// A shape, with those in between, that are morphs of a node, and the number that moves it.
struct FbxShapeChannel {
  std::int64_t object = 0;                 ///< id of the Deformer "BlendShapeChannel", or of the Geometry
  std::string property = "DeformPercent";  ///< of the object; of a Geometry it bears the shape's name
  int node = -1;
  double percent = 0;                       ///< DeformPercent at rest
  std::vector<ShapeChannel::Shape> shapes;  ///< by full weight, ascending; `morph` of the node
};

/// Adds a clip for each AnimationStack, in the file's order. models: the Model of each node of the character, null for
/// nodes that are none. Shapes: one for each use by a node. What is in the file but cannot be evaluated becomes notes
/// and contents.
void read_fbx_clips(const FbxDocument& document, std::span<const FbxObject* const> models,
                    std::span<const FbxShapeChannel> shapes, Character& out);

}  // namespace ft::inline io
