// File -> Character through assimp: opening and nodes. Meshes and clips are in the files beside this one. Collada and
// glTF 1.0 arrive as metres and Y-up (collada_read.h takes the metres back). A BVH carries neither.
#include "io/import/files/assimp_read.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <optional>
#include <set>

#include "baker/core/file.h"
#include "io/import/collada/collada_check.h"
#include "io/import/collada/collada_file.h"
#include "io/import/collada/collada_read.h"
#include "io/reading/lower_extension.h"
#include "io/reading/reading_step.h"

namespace ft::inline io {
namespace {

/// Remembers which files were opened: they are part of the input. Gives a text in place of the main file where one is
/// set.
class RecordingFiles : public Assimp::DefaultIOSystem {
 public:
  RecordingFiles(std::string main_file, std::string text) : main_file_(std::move(main_file)), text_(std::move(text)) {}
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    Assimp::IOStream* stream = DefaultIOSystem::Open(file, mode);
    if (stream == nullptr) return stream;
    opened_.insert(file);
    if (text_.empty() || file != main_file_) return stream;
    Close(stream);
    auto* copy = new std::uint8_t[text_.size()];
    std::copy(text_.begin(), text_.end(), copy);
    return new Assimp::MemoryIOStream(copy, text_.size(), true);
  }
  const std::set<std::string>& opened() const { return opened_; }

 private:
  std::set<std::string> opened_;
  std::string main_file_, text_;
};

std::string format_name(const Assimp::Importer& importer) {
  const int index = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* about = index >= 0 ? importer.GetImporterInfo(static_cast<std::size_t>(index)) : nullptr;
  const std::string name = about != nullptr && about->mName != nullptr ? about->mName : "";
  for (const auto& [word, format] : {std::pair{"glTF", "glTF"}, {"BVH", "BVH"}, {"Collada", "Collada"}})
    if (name.find(word) != std::string::npos) return format;
  return name.empty() ? "unknown" : name.substr(0, name.find(" Importer"));
}

Mat4 matrix(const aiMatrix4x4& m) {
  Mat4 out;
  for (unsigned r = 0; r < 4; ++r)
    for (unsigned c = 0; c < 4; ++c) out(r, c) = static_cast<double>(m[r][c]);
  return out;
}

void record_dependencies(const std::filesystem::path& file, const std::set<std::string>& opened, Character& out) {
  for (const std::string& path : opened) {
    std::error_code ignored;
    if (std::filesystem::equivalent(path, file, ignored)) continue;
    const auto bytes = read_file(path);
    if (!bytes) continue;
    const auto relative = std::filesystem::path(path).lexically_relative(file.parent_path());
    out.dependencies.push_back({relative.empty() ? path : relative.string(), hash_bytes(*bytes)});
  }
}

}  // namespace

std::vector<const aiNode*> read_nodes(const aiScene& scene, Character& out) {
  std::vector<const aiNode*> nodes;
  std::vector<std::pair<const aiNode*, int>> stack{{scene.mRootNode, -1}};
  while (!stack.empty() && nodes.size() <= k_max_character_nodes) {
    const auto [node, parent] = stack.back();
    stack.pop_back();
    const int index = static_cast<int>(nodes.size());
    nodes.push_back(node);
    out.nodes.push_back({node->mName.C_Str(), parent, matrix(node->mTransformation), {}});
    for (unsigned i = node->mNumChildren; i-- > 0;)
      if (node->mChildren[i] != nullptr) stack.push_back({node->mChildren[i], index});
  }
  return nodes;
}

Result<Character> read_with_assimp(const std::filesystem::path& file) {
  std::optional<ColladaFile> collada;
  std::string text;
  if (const std::string end = lower_extension(file); end == ".dae" || end == ".xml") {
    reading_step("the file as Collada");
    auto opened = ColladaFile::open(file);
    if (!opened && end == ".dae") return opened.error();
    if (opened && std::string(opened->root().name()) == "COLLADA") {
      if (Status s = check_collada(*opened); !s) return s.error();
      text = with_bind_shape_matrices(*opened);
      collada = std::move(*opened);
    }
  }
  Assimp::Importer importer;
  auto* files = new RecordingFiles(file.string(), std::move(text));  // owned by the importer
  importer.SetIOHandler(files);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES,
                           true);  // drawings of the bones where a file has no mesh
  // No joining of vertices (it ignores weights and morphs), no GlobalScale (float): welding and units are done here, in
  // double.
  const std::string with = ", with assimp's reader of " + file.extension().string();
  reading_step("the file" + with);
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  reading_step("its polygons" + with);
  if (scene != nullptr) scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string reason = importer.GetErrorString();
    if (reason.find("bad allocation") != std::string::npos || reason.find("bad_alloc") != std::string::npos)
      return input_error("needs more memory than the import may use");
    return input_error("cannot be read: " + (reason.empty() ? std::string("no scene in it") : reason));
  }

  Character out;
  out.format = format_name(importer);
  if (out.format == "BVH") out.file_unit = 0, out.file_up.clear();
  reading_step("its nodes" + with);
  const std::vector<const aiNode*> nodes = read_nodes(*scene, out);
  if (nodes.size() > k_max_character_nodes) return input_error("has more than 200,000 nodes");
  reading_step("its meshes and skins" + with);
  if (out.format != "BVH") read_meshes(*scene, nodes, out);
  reading_step("its clips" + with);
  read_clips(*scene, nodes, out);
  record_dependencies(file, files->opened(), out);
  if (out.format == "glTF") out.notes.emplace_back("is glTF 1.0: only its shapes were read");
  if (collada) read_collada_over(*collada, out);
  if (out.format == "Collada" && !collada)
    out.notes.emplace_back("is Collada in an archive: read by assimp, steps and curves in the file may be lost");
  return out;
}

}  // namespace ft::inline io
