// Colours of an OBJ's vertices as weights.
#pragma once

#include <string>
#include <vector>

#include "baker/core/mesh.h"

namespace ft::inline io {

inline constexpr double k_largest_colour = 255;

/// Some tools write colours as 0..1, others as 0..255; one value decides for the whole file. Light that was baked into
/// the colours may also lie a little above 1. largest: of all components. A note where they are not as they stand.
std::string scale_colours(std::vector<Vec3>& colours, double largest);

/// "red", "green", "blue": the vertices with some of it, and how much; groups without a vertex are left out.
std::vector<VertexGroup> groups_of_colours(const std::vector<Vec3>& colours);

}  // namespace ft::inline io
