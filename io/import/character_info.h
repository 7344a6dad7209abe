// What is told of a character: its meshes, bones, clips and what its file holds besides.
#pragma once

#include <vector>

#include "io/import/character/character.h"
#include "io/import/character/import_request.h"

namespace ft::inline io {

/// meshes: those that make the collider. Notes of the file come before those that are there.
void describe(const Character& character, const std::vector<int>& meshes, CharacterInfo& info);

}  // namespace ft::inline io
