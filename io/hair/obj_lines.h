// Polylines of an OBJ file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/types.h"

namespace ft::inline io {

/// Whether an OBJ's text has an l element.
bool has_obj_lines(std::string_view text);

/// The l elements in the file's order and unit; `where` is named in messages. Elements that meet at their ends, two at
/// a vertex, are one line, which begins at the end that the file numbers lower: programs write curves edge by edge.
/// Circles have no root and are left out with a note.
Result<std::vector<std::vector<Vec3>>> parse_obj_lines(std::string_view text, std::string_view where,
                                                       std::vector<std::string>& notes);

}  // namespace ft::inline io
