#include "io/import/files/read_character.h"

#include "io/import/bvh/bvh_character.h"
#include "io/import/files/assimp_read.h"

namespace ft::inline io {

Result<Character> read_character(const std::filesystem::path& file) {
  if (is_bvh(file)) return read_bvh_character(file);
  return read_with_assimp(file);
}

}  // namespace ft::inline io
