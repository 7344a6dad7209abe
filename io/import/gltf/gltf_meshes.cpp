#include "io/import/gltf/gltf_meshes.h"

#include <algorithm>

#include "io/import/gltf/gltf_primitive.h"

namespace ft::inline io::gltf {
namespace {

/// The joints of a skin as bones of the character. A skin without inverse bind matrices has identities.
Result<std::vector<SkinBone>> read_skin(GltfFile& file, std::int64_t index, const std::vector<int>& node_of) {
  const Json& skin = element(member(file.json(), "skins"), index);
  const std::string name = named(file.json(), "skins", index);
  const Json& joints = member(skin, "joints");
  if (!skin.is_object() || size_of_array(joints) == 0) return input_error(name + " is not there, or has no joints");
  AccessorValues binds;
  if (skin.contains("inverseBindMatrices")) {
    auto read = file.read(integer(member(skin, "inverseBindMatrices"), -1), Integers::k_as_flagged);
    if (!read) return input_error(name + ": inverseBindMatrices: " + read.error().what);
    if (read->width != 16 || read->count() < joints.size())
      return input_error(name + " has " + std::to_string(read->count()) + " inverse bind matrices for " +
                         std::to_string(joints.size()) + " joints");
    binds = std::move(*read);
  }
  std::vector<SkinBone> out;
  out.reserve(joints.size());
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const std::int64_t node = integer(joints[k], -1);
    if (node < 0 || static_cast<std::size_t>(node) >= node_of.size() || node_of[static_cast<std::size_t>(node)] < 0)
      return input_error(name + ": its joint nodes[" + std::to_string(node) + "] is not there");
    SkinBone bone;
    bone.node = node_of[static_cast<std::size_t>(node)];
    if (binds.width > 0) bone.inverse_bind = Eigen::Map<const Mat4>(binds.values.data() + 16 * k);
    out.push_back(bone);
  }
  return out;
}

/// A mesh as it was read, and how many nodes will still ask for it.
struct Shared {
  std::vector<Primitive> primitives;
  std::size_t users = 0, uses = 0;
  bool read = false, skinned = false;
};

class MeshReader {
 public:
  MeshReader(GltfFile& file, const std::vector<int>& node_of, Character& out)
      : file_(file),
        node_of_(node_of),
        out_(out),
        shared_(size_of_array(member(file.json(), "meshes"))),
        skins_(size_of_array(member(file.json(), "skins"))) {}

  Status run() {
    const Json& nodes = member(file_.json(), "nodes");
    // In the order of the character's nodes, so that what is drawn first comes first.
    std::vector<std::int64_t> order(out_.nodes.size(), -1);
    for (std::size_t n = 0; n < node_of_.size(); ++n)
      if (node_of_[n] >= 0) order[static_cast<std::size_t>(node_of_[n])] = static_cast<std::int64_t>(n);
    find_hidden(order, nodes);
    std::erase_if(order, [&](std::int64_t n) { return !element(nodes, n).contains("mesh"); });
    for (const std::int64_t n : order)
      if (Status s = count_use(n, nodes[static_cast<std::size_t>(n)]); !s) return s;
    for (const std::int64_t n : order)
      if (Status s = add_use(n, nodes[static_cast<std::size_t>(n)]); !s) return s;
    for (std::string& note : odd_.notes()) out_.notes.push_back(std::move(note));
    return {};
  }

 private:
  /// KHR_node_visibility: a hidden node hides what is below it.
  void find_hidden(const std::vector<std::int64_t>& json_node, const Json& nodes) {
    hidden_.assign(out_.nodes.size(), 0);
    for (std::size_t i = 0; i < hidden_.size(); ++i) {
      const Json& extensions = member(element(nodes, json_node[i]), "extensions");
      const Json& visible = member(member(extensions, "KHR_node_visibility"), "visible");
      const int parent = out_.nodes[i].parent;
      hidden_[i] = (visible.is_boolean() && !visible.get<bool>()) ||
                   (parent >= 0 && hidden_[static_cast<std::size_t>(parent)] != 0);
    }
  }

  Status count_use(std::int64_t n, const Json& node) {
    const std::int64_t mesh = integer(member(node, "mesh"), -1);
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= shared_.size())
      return input_error(named(file_.json(), "nodes", n) + ": its meshes[" + std::to_string(mesh) + "] is not there");
    Shared& shared = shared_[static_cast<std::size_t>(mesh)];
    ++shared.users;
    if (node.contains("skin")) shared.skinned = true;
    return {};
  }

  Status add_use(std::int64_t n, const Json& node) {
    const std::int64_t index = integer(member(node, "mesh"), -1);
    const Json& mesh = element(member(file_.json(), "meshes"), index);
    Shared& shared = shared_[static_cast<std::size_t>(index)];
    if (!shared.read)
      if (Status s = read(index, mesh, shared); !s) return s;
    const bool last = ++shared.uses == shared.users;
    CharacterNode& ours = out_.nodes[static_cast<std::size_t>(node_of_[static_cast<std::size_t>(n)])];
    std::size_t morph_count = 0;
    for (Primitive& primitive : shared.primitives) {
      if (primitive.mesh.triangles.empty()) continue;
      if (shared.uses > 1)
        for (const Status& s : {room_.take(primitive.mesh.positions.size(), primitive.mesh.morphs.size()),
                                room_.take_triangles(primitive.mesh.triangles.size())})
          if (!s) return s;
      morph_count = std::max(morph_count, primitive.mesh.morphs.size());
      CharacterMesh& added = out_.meshes.emplace_back(last ? std::move(primitive.mesh) : primitive.mesh);
      added.node = node_of_[static_cast<std::size_t>(n)];
      added.visible = hidden_[static_cast<std::size_t>(added.node)] == 0;
      if (!node.contains("skin") || primitive.weights.empty()) continue;
      if (Status s = put_skin(integer(member(node, "skin"), -1), primitive.weights, last, added); !s)
        return input_error(named(file_.json(), "nodes", n) + ": " + s.error().what);
    }
    if (last) shared.primitives.clear();
    ours.morph_weights.assign(morph_count, 0.0);
    std::vector<double> weights = numbers(member(node, "weights"));
    if (weights.empty()) weights = numbers(member(mesh, "weights"));
    std::copy_n(weights.begin(), std::min(weights.size(), morph_count), ours.morph_weights.begin());
    return {};
  }

  Status read(std::int64_t index, const Json& mesh, Shared& shared) {
    const std::string name = name_or_place(mesh, "meshes", index);
    const Json& primitives = member(mesh, "primitives");
    for (std::size_t p = 0; p < size_of_array(primitives); ++p) {
      auto primitive = read_primitive(file_, mesh, primitives[p], shared.skinned, room_, odd_);
      if (!primitive)
        return input_error(named(file_.json(), "meshes", index) + ", primitive " + std::to_string(p) + ": " +
                           primitive.error().what);
      primitive->mesh.name = primitives.size() > 1 ? name + "-" + std::to_string(p) : name;
      shared.primitives.push_back(std::move(*primitive));
    }
    shared.read = true;
    return {};
  }

  Status put_skin(std::int64_t index, JointWeights& weights, bool last, CharacterMesh& mesh) {
    if (index < 0 || static_cast<std::size_t>(index) >= skins_.size())
      return input_error("its skins[" + std::to_string(index) + "] is not there");
    std::vector<SkinBone>& bones = skins_[static_cast<std::size_t>(index)];
    if (bones.empty()) {
      auto read = read_skin(file_, index, node_of_);
      if (!read) return read.error();
      bones = std::move(*read);
    }
    if (weights.most_joint >= static_cast<int>(bones.size()))
      return input_error("a vertex names joint " + std::to_string(weights.most_joint) + " of " +
                         named(file_.json(), "skins", index) + ", which has " + std::to_string(bones.size()));
    mesh.bones = bones;
    mesh.influence_start = last ? std::move(weights.start) : weights.start;
    mesh.influence_bone = last ? std::move(weights.joint) : weights.joint;
    mesh.influence_weight = last ? std::move(weights.weight) : weights.weight;
    return {};
  }

  GltfFile& file_;
  const std::vector<int>& node_of_;
  Character& out_;
  std::vector<Shared> shared_;
  std::vector<std::vector<SkinBone>> skins_;
  std::vector<char> hidden_;  ///< by node of the character
  MeshRoom room_;
  MeshOddities odd_;
};

}  // namespace

Status read_meshes(GltfFile& file, const std::vector<int>& node_of, Character& out) {
  return MeshReader(file, node_of, out).run();
}

}  // namespace ft::inline io::gltf
