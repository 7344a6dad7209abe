// Vertices of a body cache that are, for a few samples, where no body can have them: without a finite position, or torn
// out from among their neighbours by a great deal and back again. One of them drives a spike of skin through the
// garments, and a frame then takes minutes. They are put back to where their neighbours have them, and named.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/import/character/geometry_cache.h"

namespace ft::inline io {

/// Mends `cache`, whose faces are read. What it lists is sorted by sample and vertex. Error: a vertex that is not
/// finite for longer than can be mended.
Result<std::vector<StrayVertex>> mend_stray_vertices(GeometryCache& cache, const std::string& file);

/// One sentence for what strays over the same samples; at most `most` and a count of the rest. frame_of(sample): frame
/// of the shot, for users.
std::vector<std::string> stray_notes(std::span<const StrayVertex> strays, const std::string& file,
                                     double metres_per_unit, const std::function<double(int)>& frame_of,
                                     std::size_t most = 6);

}  // namespace ft::inline io
