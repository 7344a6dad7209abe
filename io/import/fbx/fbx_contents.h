// What an FBX file holds, kind by kind, and a note with names for each kind that moves or makes a body and is not
// evaluated.
#pragma once

#include "io/import/character/character.h"
#include "io/import/fbx/fbx_document.h"

namespace ft::inline io {

/// Adds to out.contents and out.notes; clips say themselves what becomes of animation.
void list_fbx_contents(const FbxDocument& document, Character& out);

}  // namespace ft::inline io
