// What assimp gets wrong in Collada files, put right from the file's XML: units, transforms, animation.
#pragma once

#include "io/import/collada/collada_file.h"

namespace ft::inline io {

/// Of a character that assimp read from that file: its unit moves out of the root's matrix into `file_unit`, nodes at
/// rest and clips are those of the XML. Where the XML cannot be followed a note says what is in doubt.
void read_collada_over(const ColladaFile& file, Character& character);

}  // namespace ft::inline io
