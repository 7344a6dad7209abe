// A Model's transform as the FBX SDK builds it: translation, rotation offset and pivot, pre-rotation, rotation,
// post-rotation, the pivot back, scaling offset and pivot, scaling, the pivot back.
#pragma once

#include <string>
#include <vector>

#include "io/import/character/transform_stack.h"
#include "io/import/fbx/fbx_document.h"

namespace ft::inline io {

/// A Model's elements and the property that each takes its numbers from.
struct FbxTransform {
  TransformStack stack;                 ///< elements that can be animated only are left out unless `whole`
  std::vector<std::string> properties;  ///< one per element; empty: constant
  bool spherical = false;               ///< "spheric XYZ" is asked for, which turns as XYZ here
};

/// whole: with elements that change nothing unless they are animated.
FbxTransform fbx_transform(const FbxObject& model, int node, bool whole);

/// Matrices at rest relative to the parents (-1: none), which come before their children. What is null stays as it is
/// in `locals`.
void fbx_rest_locals(std::span<const FbxObject* const> models, std::span<const int> parents, std::span<Mat4> locals);

}  // namespace ft::inline io
