#include "io/import/files/read_character.h"

#include "io/import/bvh/bvh_character.h"
#include "io/import/files/assimp_read.h"
#include "io/import/gltf/gltf_read.h"

namespace ft::inline io {

Result<Character> read_character(const std::filesystem::path& file) {
  if (is_bvh(file)) return read_bvh_character(file);
  if (is_gltf(file)) {
    auto out = read_gltf(file);
    if (out || !is_still_gltf_1(file)) return out;
  }
  return read_with_assimp(file);
}

}  // namespace ft::inline io
