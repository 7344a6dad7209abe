// Motion capture from a BVH, as a Character without a mesh. Joints become nodes in the order of the text, end sites
// among them under the name "EndSite_" and their parent's; the motion becomes the clip "Motion". Double throughout.
//
// What a position channel means is no part of the format. It is where the joint is below its parent, in place of its
// OFFSET, as nearly all programs write it; a file in which that would fold the skeleton up, because the channels are
// near 0 and the OFFSETs are not, has them added instead. Both ways, and OFFSETs taken from the motion where there are
// none, are notes.
#pragma once

#include <filesystem>

#include "io/import/bvh/bvh_file.h"
#include "io/import/character/character.h"

namespace ft::inline io {

/// Whether the first word of a file, behind a byte order mark, is HIERARCHY; or its name ends in .bvh.
bool is_bvh(const std::filesystem::path& file);

/// Errors name the line.
Result<Character> read_bvh_character(const std::filesystem::path& file);

Character bvh_character(BvhFile file);

}  // namespace ft::inline io
