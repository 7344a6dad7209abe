// File -> Character through assimp: opening, units and axes, nodes. Meshes and clips are in the files beside this one.
// assimp converts neither units nor axes of FBX; both are passed on as metadata (a float and five ints) and applied by
// us, in double. Collada and glTF arrive as metres and Y-up (collada_read.h takes the metres back). A BVH carries
// neither.
#include "io/import/files/assimp_read.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <map>
#include <set>

#include "baker/core/file.h"
#include "io/import/collada/collada_file.h"
#include "io/import/collada/collada_read.h"
#include "io/reading/reading_step.h"

namespace ft::inline io {
namespace {

/// Remembers which files were opened: they are part of the input.
class RecordingFiles : public Assimp::DefaultIOSystem {
 public:
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    Assimp::IOStream* stream = DefaultIOSystem::Open(file, mode);
    if (stream == nullptr) return stream;
    opened_.insert(file);
    if (const std::string end = std::filesystem::path(file).extension(); end != ".dae" && end != ".DAE") return stream;
    const auto [found, is_new] = repaired_.try_emplace(file);
    if (is_new) found->second = with_bind_shape_matrices(file);
    const std::string& text = found->second;
    if (text.empty()) return stream;
    Close(stream);
    auto* copy = new std::uint8_t[text.size()];
    std::copy(text.begin(), text.end(), copy);
    return new Assimp::MemoryIOStream(copy, text.size(), true);
  }
  const std::set<std::string>& opened() const { return opened_; }

 private:
  std::set<std::string> opened_;
  std::map<std::string, std::string> repaired_;  // texts, by file; empty where it is good as it is
};

std::string format_name(const Assimp::Importer& importer) {
  const int index = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* about = index >= 0 ? importer.GetImporterInfo(static_cast<std::size_t>(index)) : nullptr;
  const std::string name = about != nullptr && about->mName != nullptr ? about->mName : "";
  for (const auto& [word, format] : {std::pair{"glTF", "glTF"}, {"FBX", "FBX"}, {"BVH", "BVH"}, {"Collada", "Collada"}})
    if (name.find(word) != std::string::npos) return format;
  return name.empty() ? "unknown" : name.substr(0, name.find(" Importer"));
}

Vec3 axis(int index, int sign) {
  Vec3 v = Vec3::Zero();
  if (index >= 0 && index < 3) v[index] = sign < 0 ? -1 : 1;
  return v;
}

/// Up, front and right of the file become Y, Z and X; a left-handed or nonsensical set keeps only its up axis.
void read_fbx_frame(const aiMetadata& data, Character& out) {
  float unit = 0;
  double unit_double = 0;
  if (data.Get("UnitScaleFactor", unit))
    out.file_unit = 0.01 * static_cast<double>(unit);
  else if (data.Get("UnitScaleFactor", unit_double))
    out.file_unit = 0.01 * unit_double;
  else
    out.file_unit = 0.01;
  if (!(out.file_unit > 1e-9 && out.file_unit < 1e9)) {
    out.notes.push_back("the file's unit is not a number above 0; centimetres assumed");
    out.file_unit = 0.01;
  }
  int up = 1, up_sign = 1, front = 2, front_sign = 1, right = 0, right_sign = 1;
  data.Get("UpAxis", up), data.Get("UpAxisSign", up_sign);
  data.Get("FrontAxis", front), data.Get("FrontAxisSign", front_sign);
  data.Get("CoordAxis", right), data.Get("CoordAxisSign", right_sign);
  Mat3 axes;
  axes.row(0) = axis(right, right_sign);
  axes.row(1) = axis(up, up_sign);
  axes.row(2) = axis(front, front_sign);
  if (axes.determinant() < 0.5) {
    const Vec3 y = axis(up, up_sign).norm() > 0.5 ? axis(up, up_sign) : Vec3::UnitY().eval();
    axes = Quat::FromTwoVectors(y, Vec3::UnitY()).toRotationMatrix();
    axes = axes.array().round().matrix();
    out.notes.push_back("the file's axes are not right-handed; only its up axis was used");
  }
  out.file_axes = axes;
  const char* names[] = {"x", "y", "z"};
  out.file_up = std::string(up_sign < 0 ? "-" : "") + (up >= 0 && up < 3 ? names[up] : "y");
}

Mat4 matrix(const aiMatrix4x4& m) {
  Mat4 out;
  for (unsigned r = 0; r < 4; ++r)
    for (unsigned c = 0; c < 4; ++c) out(r, c) = static_cast<double>(m[r][c]);
  return out;
}

constexpr const char* k_pivot_mark = "_$AssimpFbx$_";

/// Name of the node that a pivot node belongs to; empty when it is none. Geometric transforms stay nodes: they move the
/// mesh only.
std::string pivot_owner(const aiNode& node) {
  const std::string name = node.mName.C_Str();
  const auto at = name.find(k_pivot_mark);
  if (at == std::string::npos || name.find("Geometric", at) != std::string::npos) return {};
  return name.substr(0, at);
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

AssimpNodes read_nodes(const aiScene& scene, Character& out) {
  AssimpNodes nodes;
  std::vector<std::pair<const aiNode*, int>> stack{{scene.mRootNode, -1}};
  while (!stack.empty() && nodes.raw.size() <= k_max_character_nodes) {
    const auto [node, parent] = stack.back();
    stack.pop_back();
    const int index = static_cast<int>(nodes.raw.size());
    nodes.raw.push_back(node);
    nodes.raw_parent.push_back(parent);
    for (unsigned i = node->mNumChildren; i-- > 0;)
      if (node->mChildren[i] != nullptr) stack.push_back({node->mChildren[i], index});
  }

  nodes.node_of_raw.assign(nodes.raw.size(), -1);
  std::vector<int>
      pending;  // pivots met on the way down to their owner; raw order is depth first, so they are neighbours
  for (std::size_t i = 0; i < nodes.raw.size(); ++i) {
    const aiNode& raw = *nodes.raw[i];
    const std::string owner = pivot_owner(raw);
    if (!owner.empty() && raw.mNumChildren == 1 && raw.mNumMeshes == 0) {
      const aiNode& next = *raw.mChildren[0];
      if (pivot_owner(next) == owner || next.mName.C_Str() == owner) {
        pending.push_back(static_cast<int>(i));
        continue;
      }
    }
    pending.push_back(static_cast<int>(i));
    CharacterNode node;
    node.name = raw.mName.C_Str();
    const int above = nodes.raw_parent[static_cast<std::size_t>(pending.front())];
    node.parent = above < 0 ? -1 : nodes.node_of_raw[static_cast<std::size_t>(above)];
    for (const int k : pending) {
      node.local = node.local * matrix(nodes.raw[static_cast<std::size_t>(k)]->mTransformation);
      nodes.node_of_raw[static_cast<std::size_t>(k)] = static_cast<int>(out.nodes.size());
    }
    out.nodes.push_back(std::move(node));
    nodes.chain.push_back(std::move(pending));
    pending.clear();
  }
  return nodes;
}

Result<Character> read_with_assimp(const std::filesystem::path& file) {
  Assimp::Importer importer;
  auto* files = new RecordingFiles;  // owned by the importer
  importer.SetIOHandler(files);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, false);
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
  if (out.format == "FBX" && scene->mMetaData != nullptr) read_fbx_frame(*scene->mMetaData, out);
  if (out.format == "BVH") out.file_unit = 0, out.file_up.clear();
  reading_step("its nodes" + with);
  const AssimpNodes nodes = read_nodes(*scene, out);
  if (nodes.raw.size() > k_max_character_nodes) return input_error("has more than 200,000 nodes");
  reading_step("its meshes and skins" + with);
  if (out.format != "BVH") read_meshes(*scene, nodes, out);
  reading_step("its clips" + with);
  read_clips(*scene, nodes, out);
  record_dependencies(file, files->opened(), out);
  if (out.format == "glTF") out.notes.emplace_back("is glTF 1.0: only its shapes were read");
  if (out.format == "Collada") read_collada_over(file, out);
  return out;
}

}  // namespace ft::inline io
