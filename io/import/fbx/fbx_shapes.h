// Blend shapes of FBX meshes: sparse offsets, shapes in between, weights at rest.
#pragma once

#include "io/import/fbx/fbx_scene.h"

namespace ft::inline io {

/// Adds the shapes of a Geometry to its mesh, their rest weights to `rest`, and what moves them to `channels`. linear:
/// of the geometric transform. Returns how many shapes have offsets for vertices that are not there.
int read_fbx_shapes(const FbxDocument& document, const FbxObject& geometry, const Mat3& linear, CharacterMesh& mesh,
                    std::vector<double>& rest, std::vector<FbxShapeChannel>& channels);

/// The node's numbers by threes.
std::vector<Vec3> fbx_points(const FbxNode* node);

}  // namespace ft::inline io
