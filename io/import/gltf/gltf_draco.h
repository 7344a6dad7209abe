// KHR_draco_mesh_compression: the triangles and attributes of a primitive out of one compressed block. The types of
// draco stop at gltf_draco.cpp.
#pragma once

#include <string>

#include "io/import/character/character.h"
#include "io/import/gltf/gltf_file.h"

namespace ft::inline io::gltf {

struct DracoMesh {
  std::vector<Triangle> triangles;
  std::size_t vertex_count = 0;
  std::map<std::string, AccessorValues> attributes;  ///< those that were asked for and are in the block
};

/// extension: the primitive's. Attributes are read as the accessors of the same name say (normalised or not); weights
/// are fractions always.
Result<DracoMesh> read_draco(GltfFile& file, const Json& primitive, const Json& extension);

}  // namespace ft::inline io::gltf
