// A .glb of a character's skeleton and motion, where the file's own bytes cannot be edited (FBX, Collada): nodes, one
// skin, one animation, no meshes. It plays on the original character again as its animation file.
#pragma once

#include "baker/core/bytes.h"
#include "io/import/character/character.h"

namespace ft::inline io {

/// In metres and Y up: placement (a uniform scale and a rotation) goes into lengths and, where axes turn, into one more
/// node at the top. Tracks keep their keys, stacks of transforms become tracks (plain_clip.h). Errors: a clip that does
/// not exist, a placement that is no similarity. notes: what glTF cannot hold of it.
Result<Bytes> glb_from_character(const Character& character, int clip, const Mat4& placement,
                                 std::vector<std::string>& notes);

}  // namespace ft::inline io
