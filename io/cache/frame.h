// What is checked of a cache and its frames before a byte is written. Shapes and frames themselves are words of the
// lowest floor: baker/core/output_shape.h, output_frame.h.
#pragma once

#include <span>
#include <string>

#include "baker/core/output_frame.h"
#include "baker/core/result.h"

namespace ft::inline io {

struct CacheInfo;

/// What is wrong with a cache before its first frame: counts that do not agree, ids that are there twice.
Status check_rest(const CacheInfo& info);

/// What is wrong with a frame: counts, numbers that are not finite, faces, ids. Says where: frame, system, vertex.
/// velocities: whether this cache has them.
Status check_frame(const CacheFrame& frame, const CacheInfo& info, int frame_index, bool velocities);

/// Faces are whole and use vertices that are there; an empty message when they are.
std::string fault_of_faces(std::span<const int> sizes, std::span<const int> corners, std::size_t vertex_count);

}  // namespace ft::inline io
