#include "io/import/body/figure.h"

#include <algorithm>
#include <array>

namespace ft::inline io {
namespace {

constexpr std::size_t k_most_limbs = 64;  ///< of a kind: more are no figure

class FigureFinder {
 public:
  FigureFinder(const Character& character, std::span<const Limb> limb, int root)
      : character_(character), limb_(limb), in_tree_(limb.size(), root < 0) {
    for (int i = std::max(root, 0); root >= 0 && i < count(); ++i) {
      const int parent = character.nodes[at(i)].parent;
      in_tree_[at(i)] = i == root || (parent >= root && in_tree_[at(parent)]);
    }
  }

  Figure find() {
    Figure out;
    out.legs = pair_of(Limb::k_thigh, Limb::k_shin, Limb::k_foot);
    out.arms = pair_of(Limb::k_upper_arm, Limb::k_forearm, Limb::k_hand);
    out.hips = above(out.legs), out.chest = above(out.arms);
    out.base = out.hips < 0 ? out.chest : out.chest < 0 ? out.hips : common(out.hips, out.chest);
    for (int i = 0; i < count(); ++i) {
      if (!in_tree(i) || is_end(i)) continue;
      if (out.neck < 0 && (kind(i) == Limb::k_neck || kind(i) == Limb::k_head)) out.neck = i;
      if (out.head < 0 && kind(i) == Limb::k_head) out.head = i;
    }
    return out;
  }

 private:
  int count() const { return static_cast<int>(limb_.size()); }
  Limb kind(int node) const { return limb_[at(node)]; }
  bool in_tree(int node) const { return in_tree_[at(node)] != 0; }
  bool is_end(int node) const { return is_end_site(character_.nodes[at(node)]); }

  int common(int a, int b) const {
    while (a != b) {
      if (a < 0 || b < 0) return -1;
      (a > b ? a : b) = character_.nodes[at(std::max(a, b))].parent;
    }
    return a;
  }
  int above(const std::vector<FigureLimb>& limbs) const {
    if (limbs.size() != 2) return -1;
    return common(limbs[0].upper, limbs[1].upper);
  }

  int first_below(int node, Limb wanted) const {
    std::vector<char> below(at(count()), 0);
    below[at(node)] = 1;
    for (int i = node + 1; i < count(); ++i) {
      const int parent = character_.nodes[at(i)].parent;
      below[at(i)] = parent >= node && below[at(parent)];
      if (below[at(i)] && kind(i) == wanted && !is_end(i)) return i;
    }
    return -1;
  }

  bool bears_skin(int node) const {
    for (const CharacterMesh& mesh : character_.meshes)
      for (const SkinBone& bone : mesh.bones)
        if (bone.node == node) return true;
    return false;
  }

  /// The two limbs of a kind. Where more joints have such a name, those with a lower part and an end.
  std::vector<FigureLimb> pair_of(Limb upper, Limb lower, Limb end) const {
    std::vector<FigureLimb> out;
    for (int i = 0; i < count(); ++i) {
      const int parent = character_.nodes[at(i)].parent;
      if (kind(i) != upper || !in_tree(i) || is_end(i) || (parent >= 0 && kind(parent) == upper)) continue;
      FigureLimb limb;
      limb.upper = i;
      limb.side = side_by_name(character_.nodes[at(i)].name);
      out.push_back(limb);
    }
    if (out.size() > k_most_limbs) return out;
    for (FigureLimb& limb : out) {
      limb.lower = first_below(limb.upper, lower);
      if (limb.lower >= 0) limb.end = first_below(limb.lower, end);
    }
    for (const bool whole : {false, true})
      if (out.size() > 2) std::erase_if(out, [&](const FigureLimb& l) { return whole ? !l.whole() : l.lower < 0; });
    if (out.size() > 2)  // a rig's copies of its limbs move no skin
      std::erase_if(out, [&](const FigureLimb& l) { return !bears_skin(l.upper); });
    const bool told = out.size() == 2 && out[0].side != Side::k_none && out[1].side != Side::k_none;
    if (told && out[0].side == out[1].side) out[0].side = out[1].side = Side::k_none;
    return out;
  }

  const Character& character_;
  std::span<const Limb> limb_;
  std::vector<char> in_tree_;
};

const char* side_text(const FigureLimb& limb, std::size_t index) {
  if (limb.side == Side::k_left) return "left ";
  if (limb.side == Side::k_right) return "right ";
  return index == 0 ? "first " : "second ";
}

void list_missing(const std::vector<FigureLimb>& limbs, const char* name, const std::array<const char*, 3>& joints,
                  std::vector<std::string>& out) {
  if (limbs.size() != 2) {
    out.push_back("two " + std::string(joints[0]) + " joints (" + std::to_string(limbs.size()) + " have such a name)");
    return;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string of = std::string(" of the ") + side_text(limbs[k], k) + name;
    if (limbs[k].lower < 0) out.push_back(joints[1] + of);
    if (limbs[k].end < 0) out.push_back(joints[2] + of);
  }
}

}  // namespace

std::vector<std::string> Figure::missing() const {
  std::vector<std::string> out;
  list_missing(legs, "leg", {"thigh", "the knee", "the foot"}, out);
  list_missing(arms, "arm", {"upper arm", "the elbow", "the hand"}, out);
  if (legs.size() == 2 && arms.size() == 2 && base < 0) out.emplace_back("a joint above both arms and legs");
  return out;
}

std::vector<char> figure_nodes(const Character& character, std::span<const Limb> limb) {
  std::vector<char> out(character.nodes.size(), 0);
  std::vector<int> base(out.size(), -1);  // of the tree that a node is in
  for (std::size_t i = 0; i < out.size(); ++i) {
    const int node = static_cast<int>(i), parent = character.nodes[i].parent;
    base[i] = parent >= 0 ? base[at(parent)] : [&] {
      const Figure figure = find_figure(character, limb, node);
      return figure.legs.size() == 2 && figure.arms.size() == 2 && figure.base >= 0 ? figure.base : node;
    }();
    out[i] = node == base[i] || (parent >= 0 && out[at(parent)]);
  }
  return out;
}

Figure find_figure(const Character& character, int root) {
  return find_figure(character, limbs_by_name(character), root);
}

Figure find_figure(const Character& character, std::span<const Limb> limb, int root) {
  return FigureFinder(character, limb, root).find();
}

}  // namespace ft::inline io
