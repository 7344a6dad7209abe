// <animation> -> clips, exactly as the file animates: STEP, LINEAR, BEZIER and HERMITE keys of the elements of a node's
// transform go into stacks as they are; keys of a whole <matrix> become translation, rotation and scale.
#pragma once

#include "io/import/collada/collada_file.h"

namespace ft::inline io {

/// Puts the file's clips in place of those that the character has: one for each <animation_clip>, else one with all
/// animations. Numbers stay in the file's unit and axes. What is not evaluated becomes notes. An error leaves the
/// character as it was.
Status read_collada_clips(const ColladaFile& file, Character& character);

/// Matrix of a node at rest, from the numbers of the file.
Mat4 collada_rest(const pugi::xml_node& node);

/// What the file holds that is never evaluated: constraints, physics, morph controllers.
void note_collada_contents(const ColladaFile& file, Character& character);

}  // namespace ft::inline io
