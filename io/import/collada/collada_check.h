// What a Collada file says of itself, held against what it has: counts of arrays, reach of accessors, lengths and
// indices of <p>, <vcount> and <v>. assimp believes most of these, reads beyond the arrays, and goes round for ever at
// an index that is no number.
#pragma once

#include "io/import/collada/collada_file.h"

namespace ft::inline io {

/// The first thing that does not fit, as an error with the element's name and the id that is nearest to it.
Status check_collada(const ColladaFile& file);

}  // namespace ft::inline io
