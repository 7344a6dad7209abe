#include "io/import/gltf/gltf_nodes.h"

#include <algorithm>
#include <cmath>

namespace ft::inline io::gltf {
namespace {

constexpr int k_deepest = 1024;  ///< levels of the tree; skeletons have about 20

/// A member that is an array of `count` numbers; empty when it is absent.
Result<std::vector<double>> transform_part(const Json& node, const char* key, std::size_t count,
                                           const std::string& name) {
  const Json& value = member(node, key);
  std::vector<double> out = numbers(value);
  if (value.is_null()) return out;
  const bool good =
      out.size() == count && std::all_of(out.begin(), out.end(), [](double v) { return std::isfinite(v); });
  if (!good) return input_error(name + ": its " + key + " is not " + std::to_string(count) + " numbers");
  return out;
}

Result<Mat4> local_matrix(const Json& node, const std::string& name, int& uneven) {
  auto matrix = transform_part(node, "matrix", 16, name);
  auto t = transform_part(node, "translation", 3, name), r = transform_part(node, "rotation", 4, name),
       s = transform_part(node, "scale", 3, name);
  for (const auto* part : {&matrix, &t, &r, &s})
    if (!*part) return part->error();
  if (!matrix->empty()) {
    const Mat4 out = Eigen::Map<const Mat4>(matrix->data());
    if (out.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
      return input_error(name + ": the last row of its matrix is not 0 0 0 1", "",
                         "export it with translation, rotation and scale");
    return out;
  }
  Mat4 out = Mat4::Identity();
  if (!r->empty()) {
    const Quat q((*r)[3], (*r)[0], (*r)[1], (*r)[2]);
    const double length = q.norm();
    if (std::abs(length - 1) > 1e-4) ++uneven;
    if (length > 1e-12) out.topLeftCorner<3, 3>() = Quat(q.coeffs() / length).toRotationMatrix();
  }
  if (!s->empty()) out.topLeftCorner<3, 3>() *= Vec3((*s)[0], (*s)[1], (*s)[2]).asDiagonal();
  if (!t->empty()) out.topRightCorner<3, 1>() = Vec3((*t)[0], (*t)[1], (*t)[2]);
  return out;
}

/// Grows the character by one tree after the other.
class TreeReader {
 public:
  TreeReader(const Json& json, Character& out)
      : json_(json), nodes_(member(json, "nodes")), out_(out), of_node_(size_of_array(nodes_), -1) {}

  Status add(std::int64_t root, int parent) {
    std::vector<Entry> stack{{root, parent, -1, 1}};
    while (!stack.empty()) {
      const Entry e = stack.back();
      stack.pop_back();
      if (!element(nodes_, e.node).is_object())
        return input_error("its node tree names nodes[" + std::to_string(e.node) + "], which is not there");
      const std::string name = named(json_, "nodes", e.node);
      int& index = of_node_[static_cast<std::size_t>(e.node)];
      if (index >= 0) return second_parent(name, index, e.parent);
      if (e.depth > k_deepest) return input_error(name + " is deeper than " + std::to_string(k_deepest) + " levels");
      if (out_.nodes.size() >= k_max_character_nodes) return input_error("has more than 200,000 nodes");
      const Json& node = nodes_[static_cast<std::size_t>(e.node)];
      auto local = local_matrix(node, name, uneven_);
      if (!local) return local.error();
      index = static_cast<int>(out_.nodes.size());
      out_.nodes.push_back({name_or_place(node, "nodes", e.node), e.parent, *local, {}});
      const Json& children = member(node, "children");
      for (std::size_t k = size_of_array(children); k-- > 0;)
        stack.push_back({integer(children[k], -1), index, e.node, e.depth + 1});
    }
    return {};
  }

  bool has(std::int64_t node) const {
    return node >= 0 && static_cast<std::size_t>(node) < of_node_.size() &&
           of_node_[static_cast<std::size_t>(node)] >= 0;
  }
  int uneven() const { return uneven_; }
  std::vector<int> take() { return std::move(of_node_); }

 private:
  struct Entry {
    std::int64_t node;
    int parent;
    std::int64_t parent_in_file;
    int depth;
  };

  Status second_parent(const std::string& name, int index, int parent) const {
    for (int above = parent; above >= 0; above = out_.nodes[static_cast<std::size_t>(above)].parent)
      if (above == index) return input_error("its node tree is a circle: " + name + " is below itself");
    return input_error("its node tree is no tree: " + name + " has two parents");
  }

  const Json& json_;
  const Json& nodes_;
  Character& out_;
  std::vector<int> of_node_;
  int uneven_ = 0;
};

std::vector<std::int64_t> parents_in_file(const Json& nodes) {
  std::vector<std::int64_t> out(size_of_array(nodes), -1);
  for (std::size_t n = 0; n < out.size(); ++n) {
    const Json& children = member(nodes[n], "children");
    for (std::size_t k = 0; k < size_of_array(children); ++k) {
      const std::int64_t child = integer(children[k], -1);
      if (child >= 0 && static_cast<std::size_t>(child) < out.size())
        out[static_cast<std::size_t>(child)] = static_cast<std::int64_t>(n);
    }
  }
  return out;
}

/// Roots of the default scene; without any scene, all nodes that have no parent.
std::vector<std::int64_t> scene_roots(const Json& json, Character& out) {
  const Json& scenes = member(json, "scenes");
  std::vector<std::int64_t> roots;
  if (size_of_array(scenes) == 0) {
    const auto parents = parents_in_file(member(json, "nodes"));
    for (std::size_t n = 0; n < parents.size(); ++n)
      if (parents[n] < 0) roots.push_back(static_cast<std::int64_t>(n));
    if (!roots.empty()) out.notes.emplace_back("has no scene; all its nodes were read");
    return roots;
  }
  const std::int64_t scene = integer(member(json, "scene"), 0);
  const Json& list = member(element(scenes, scene), "nodes");
  for (std::size_t k = 0; k < size_of_array(list); ++k) roots.push_back(integer(list[k], -1));
  if (scenes.size() > 1)
    out.notes.push_back("has " + std::to_string(scenes.size()) + " scenes; " + named(json, "scenes", scene) +
                        " was read");
  return roots;
}

/// Joints of the skins that nodes of the scene use, where they are in no tree of the scene.
std::vector<std::int64_t> stray_joints(const Json& json, const TreeReader& tree) {
  std::vector<std::int64_t> out;
  const Json& nodes = member(json, "nodes");
  std::vector<char> seen(size_of_array(member(json, "skins")), 0);
  for (std::size_t n = 0; n < size_of_array(nodes); ++n) {
    const std::int64_t skin = integer(member(nodes[n], "skin"), -1);
    if (!tree.has(static_cast<std::int64_t>(n)) || skin < 0 || static_cast<std::size_t>(skin) >= seen.size()) continue;
    if (std::exchange(seen[static_cast<std::size_t>(skin)], 1)) continue;
    const Json& joints = member(element(member(json, "skins"), skin), "joints");
    for (std::size_t k = 0; k < size_of_array(joints); ++k)
      if (const std::int64_t joint = integer(joints[k], -1); element(nodes, joint).is_object() && !tree.has(joint))
        out.push_back(joint);
  }
  return out;
}

}  // namespace

Result<std::vector<int>> read_nodes(const Json& json, Character& out) {
  TreeReader tree(json, out);
  const std::vector<std::int64_t> roots = scene_roots(json, out);
  if (roots.empty()) return input_error("has no nodes in its scene");
  int above = -1;
  if (roots.size() > 1) out.nodes.push_back({"ROOT", -1, Mat4::Identity(), {}}), above = 0;
  for (const std::int64_t root : roots)
    if (Status s = tree.add(root, above); !s) return s.error();
  if (const auto stray = stray_joints(json, tree); !stray.empty()) {
    const auto parents = parents_in_file(member(json, "nodes"));
    for (std::int64_t joint : stray) {
      if (tree.has(joint)) continue;
      for (std::size_t step = 0; step < parents.size() && parents[static_cast<std::size_t>(joint)] >= 0; ++step)
        joint = parents[static_cast<std::size_t>(joint)];
      if (Status s = tree.add(joint, -1); !s) return s.error();
    }
    out.notes.push_back(std::to_string(stray.size()) + " joints are not in the scene (the first is " +
                        named(json, "nodes", stray.front()) + "); their trees were read all the same");
  }
  if (tree.uneven() > 0)
    out.notes.push_back(std::to_string(tree.uneven()) + " nodes have rotations that are not of length 1; made so");
  return tree.take();
}

std::vector<int> match_nodes(const Json& json, const Character& character) {
  Character again;
  auto node_of = read_nodes(json, again);
  const auto same = [](const CharacterNode& a, const CharacterNode& b) { return a.parent == b.parent; };
  const auto &ours = again.nodes, &theirs = character.nodes;
  if (!node_of || !std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end(), same)) return {};
  return std::move(*node_of);
}

}  // namespace ft::inline io::gltf
