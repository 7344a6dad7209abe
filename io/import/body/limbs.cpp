#include "io/import/body/limbs.h"

#include <algorithm>

#include "io/import/character/clips.h"

namespace ft::inline io {
namespace {

/// The topmost of the neighbours above `node` that are of a kind; -1 when the first that is none of the kinds comes
/// before it.
int topmost(const Character& character, const std::vector<Limb>& limb, int node, Limb kind, Limb below) {
  while (node >= 0 && limb[at(node)] == below) node = character.nodes[at(node)].parent;
  int found = -1;
  for (; node >= 0 && limb[at(node)] == kind; node = character.nodes[at(node)].parent) found = node;
  return found;
}

}  // namespace

bool is_end_site(const CharacterNode& node) {
  return node.name.starts_with("EndSite");
}

bool is_within(const Character& character, int node, int ancestor) {
  while (node > ancestor) node = character.nodes[at(node)].parent;
  return node == ancestor;
}

std::vector<Limb> limbs_by_name(const Character& character) {
  std::vector<Limb> out;
  for (const CharacterNode& node : character.nodes) {
    const bool end = is_end_site(node);
    out.push_back(end && node.parent >= 0 ? out[at(node.parent)] : limb_by_name(node.name));
  }
  // Two habits: "LeftHip - LeftKnee" means the thigh, "LeftShoulder - LeftElbow" the upper arm.
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (character.nodes[i].parent < 0) continue;
    Limb& above = out[at(character.nodes[i].parent)];
    if (above == Limb::k_hips && out[i] == Limb::k_shin) above = Limb::k_thigh;
    if (above == Limb::k_collar && out[i] == Limb::k_forearm) above = Limb::k_upper_arm;
  }
  return out;
}

std::vector<LimbChain> find_limbs(const Character& character) {
  const std::vector<Limb> limb = limbs_by_name(character);
  std::vector<LimbChain> out;
  for (int i = 0; i < static_cast<int>(limb.size()); ++i) {
    const bool foot = limb[at(i)] == Limb::k_foot, hand = limb[at(i)] == Limb::k_hand;
    const int parent = character.nodes[at(i)].parent;
    if ((!foot && !hand) || parent < 0 || limb[at(parent)] == limb[at(i)]) continue;
    LimbChain chain;
    chain.end = i;
    chain.lower = topmost(character, limb, i, foot ? Limb::k_shin : Limb::k_forearm, limb[at(i)]);
    if (chain.lower < 0) continue;
    chain.upper =
        topmost(character, limb, chain.lower, foot ? Limb::k_thigh : Limb::k_upper_arm, limb[at(chain.lower)]);
    const auto same = [&](const LimbChain& c) { return c.upper == chain.upper; };
    if (chain.upper >= 0 && std::none_of(out.begin(), out.end(), same)) out.push_back(chain);
  }
  return out;
}

Result<LimbChain> find_limb(const Character& character, const std::string& upper, const std::string& lower_name,
                            const std::string& end) {
  LimbChain out;
  for (const auto& [name, node] : {std::pair{&upper, &out.upper}, {&lower_name, &out.lower}, {&end, &out.end}}) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < character.nodes.size(); ++i) {
      names.push_back(character.nodes[i].name);
      if (names.back() != *name) continue;
      if (*node >= 0) return usage_error("node \"" + *name + "\" exists more than once");
      *node = static_cast<int>(i);
    }
    if (*node < 0) {
      const std::string guess = nearest_name(*name, names);
      return usage_error("node \"" + *name + "\" does not exist", "",
                         guess.empty() ? "" : "did you mean \"" + guess + "\"?");
    }
  }
  if (out.upper == out.lower || out.lower == out.end || !is_within(character, out.lower, out.upper) ||
      !is_within(character, out.end, out.lower))
    return usage_error("\"" + upper + "\", \"" + lower_name + "\" and \"" + end + "\" are not one above the other");
  return out;
}

}  // namespace ft::inline io
