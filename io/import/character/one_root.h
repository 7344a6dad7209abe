// A node above the roots of a file that has several.
#pragma once

#include "io/import/character/character.h"

namespace ft::inline io {

/// Puts a node "RootNode" that does nothing above several roots, as the first; nothing happens below two roots. Whoever
/// walks the nodes may then take the first for what carries them all.
void put_one_root(Character& character);

}  // namespace ft::inline io
