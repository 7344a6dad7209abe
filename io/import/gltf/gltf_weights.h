// JOINTS_n and WEIGHTS_n of a primitive as one sparse table.
#pragma once

#include <functional>

#include "io/import/gltf/gltf_primitive.h"

namespace ft::inline io::gltf {

using ReadAttribute = std::function<Result<AccessorValues>(const char* semantic, Integers integers)>;

/// All sets, joined by joint and made to sum to 1; empty when the primitive has none.
Result<JointWeights> read_weights(const Json& attributes, const ReadAttribute& read, std::size_t vertex_count,
                                  MeshOddities& odd);

}  // namespace ft::inline io::gltf
