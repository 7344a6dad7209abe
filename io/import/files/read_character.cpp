#include "io/import/files/read_character.h"

#include <fstream>

#include "baker/core/file.h"
#include "io/import/bvh/bvh_character.h"
#include "io/import/character/one_root.h"
#include "io/import/fbx/fbx_tree.h"
#include "io/import/fbx/read_fbx.h"
#include "io/import/files/assimp_read.h"
#include "io/import/gltf/gltf_read.h"
#include "io/reading/lower_extension.h"
#include "io/reading/reading_step.h"

namespace ft::inline io {
namespace {

/// What tells an FBX file from others.
Bytes head_of(const std::filesystem::path& file) {
  Bytes out(k_fbx_head);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
  out.resize(static_cast<std::size_t>(in.gcount()));
  return out;
}

}  // namespace

Result<Character> read_character(const std::filesystem::path& file) {
  reading_step("the file as BVH");
  if (is_bvh(file)) return read_bvh_character(file);
  if (is_gltf(file)) {
    reading_step("the file as glTF");
    auto out = read_gltf(file);
    if (out || !is_still_gltf_1(file)) return out;
  }
  reading_step("the file as FBX");
  if (is_fbx(head_of(file))) {
    auto bytes = read_file(file);
    if (!bytes) return bytes.error();
    auto out = read_fbx(std::move(*bytes));
    if (out) put_one_root(*out);
    return out;
  }
  if (lower_extension(file) == ".fbx")
    return input_error("is no FBX file: it begins with neither \"Kaydara FBX Binary\" nor an FBX header in text", "",
                       "copy or export it again");
  return read_with_assimp(file);
}

}  // namespace ft::inline io
