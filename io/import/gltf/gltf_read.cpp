#include "io/import/gltf/gltf_read.h"

#include <algorithm>
#include <fstream>

#include "io/import/gltf/gltf_clips.h"
#include "io/import/gltf/gltf_contents.h"
#include "io/import/gltf/gltf_meshes.h"
#include "io/import/gltf/gltf_nodes.h"
#include "io/reading/lower_extension.h"
#include "io/reading/reading_step.h"

namespace ft::inline io {
namespace {

Result<Character> read(gltf::GltfFile& file) {
  if (Status s = gltf::check_required(file.json()); !s) return s.error();
  Character out;
  out.format = "glTF";
  auto node_of = gltf::read_nodes(file.json(), out);
  if (!node_of) return node_of.error();
  reading_step("its meshes, as glTF");
  if (Status s = gltf::read_meshes(file, *node_of, out); !s) return s.error();
  reading_step("its clips, as glTF");
  if (Status s = gltf::read_clips(file, *node_of, out); !s) return s.error();
  gltf::describe_contents(file.json(), *node_of, out);
  out.dependencies = file.opened();
  return out;
}

}  // namespace

bool is_gltf(const std::filesystem::path& file) {
  char first[4] = {};
  std::ifstream in(file, std::ios::binary);
  if (in.read(first, sizeof first) && std::string_view(first, sizeof first) == "glTF") return true;
  const std::string name = lower_extension(file);
  return name == ".gltf" || name == ".glb";
}

bool is_still_gltf_1(const std::filesystem::path& path) {
  const auto file = gltf::GltfFile::open(path);
  return file && file->is_version_1() && gltf::member(file->json(), "skins").empty() &&
         gltf::member(file->json(), "animations").empty();
}

Result<Character> read_gltf(const std::filesystem::path& path) {
  try {
    auto file = gltf::GltfFile::open(path);
    if (!file) return input_error("cannot be read: " + file.error().what, "", file.error().hint);
    if (file->is_version_1())
      return input_error("is glTF 1.0; its skins and animations are not read; export it as glTF 2.0");
    auto out = read(*file);
    if (!out) return input_error("cannot be read: " + out.error().what, out.error().where, out.error().hint);
    return out;
  } catch (const gltf::Json::exception& e) {
    return input_error(std::string("cannot be read: glTF's JSON contradicts itself: ") + e.what());
  }
}

}  // namespace ft::inline io
