#include "io/import/character/match_nodes.h"

#include <algorithm>
#include <map>
#include <string>
#include <unordered_map>

#include "io/import/character/name_list.h"

namespace ft::inline io {
namespace {

constexpr std::size_t k_most_pairs = 1'000'000;  ///< of one name that are compared; more go by their order
constexpr int k_most_names = 100;                ///< that are compared upwards

/// Without a namespace ("mixamorig:Hips") or a path ("Armature|Hips"), in small letters.
std::string bare(const std::string& name) {
  const auto mark = name.find_last_of(":|");
  return small_letters(mark == std::string::npos ? name : name.substr(mark + 1));
}

/// A file's nodes by numbers that mean the same in both files.
struct Tree {
  std::vector<int> name;   ///< of the bare name
  std::vector<int> above;  ///< the nearest node above whose name both files have; -1: none
  std::vector<int> path;   ///< of the names from the root that both files have, and its own
};

using Nodes = std::vector<int>;

class Matcher {
 public:
  Matcher(const Character& source, const Character& target) : source_(source), target_(target) {
    from_.name = numbers_of(source), to_.name = numbers_of(target);
    std::vector<char> in_source(numbers_.size(), 0), in_target(numbers_.size(), 0);
    for (const int n : from_.name) in_source[at(n)] = 1;
    for (const int n : to_.name) in_target[at(n)] = 1;
    for (std::size_t n = 0; n < in_source.size(); ++n) in_source[n] = in_source[n] && in_target[n];
    find_paths(source, in_source, from_), find_paths(target, in_source, to_);
    out_.to.assign(source.nodes.size(), -1), out_.in_order.assign(source.nodes.size(), 0);
    taken_.assign(target.nodes.size(), 0);
  }

  NodeMatch match() {
    std::map<std::string, Nodes> exact;
    std::map<int, Nodes> loose;
    for (std::size_t t = 0; t < target_.nodes.size(); ++t) exact[target_.nodes[t].name].push_back(static_cast<int>(t));
    for (std::size_t t = 0; t < target_.nodes.size(); ++t) loose[to_.name[t]].push_back(static_cast<int>(t));
    std::map<std::string, Nodes> by_name;
    std::map<int, Nodes> by_number;
    for (std::size_t s = 0; s < source_.nodes.size(); ++s) {
      if (exact.contains(source_.nodes[s].name))
        by_name[source_.nodes[s].name].push_back(static_cast<int>(s));
      else if (loose.contains(from_.name[s]))
        by_number[from_.name[s]].push_back(static_cast<int>(s));
    }
    for (const auto& [name, nodes] : by_name) match_group(nodes, exact[name]);
    for (const auto& [number, nodes] : by_number) match_group(nodes, loose[number]);
    return std::move(out_);
  }

 private:
  std::vector<int> numbers_of(const Character& character) {
    std::vector<int> out;
    for (const CharacterNode& node : character.nodes)
      out.push_back(numbers_.try_emplace(bare(node.name), static_cast<int>(numbers_.size())).first->second);
    return out;
  }

  void find_paths(const Character& character, const std::vector<char>& in_both, Tree& tree) {
    for (std::size_t i = 0; i < character.nodes.size(); ++i) {
      const int parent = character.nodes[i].parent;
      tree.above.push_back(parent < 0 || in_both[at(tree.name[at(parent)])] ? parent : tree.above[at(parent)]);
      const int before = tree.above[i] < 0 ? -1 : tree.path[at(tree.above[i])];
      tree.path.push_back(paths_.try_emplace({before, tree.name[i]}, static_cast<int>(paths_.size())).first->second);
    }
  }

  void pair(int s, int t, bool guessed) { out_.to[at(s)] = t, out_.in_order[at(s)] = guessed, taken_[at(t)] = 1; }

  Nodes free_sources(const Nodes& nodes) const {
    Nodes out;
    std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(out), [&](int s) { return out_.to[at(s)] < 0; });
    return out;
  }
  Nodes free_targets(const Nodes& nodes) const {
    Nodes out;
    std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(out), [&](int t) { return !taken_[at(t)]; });
    return out;
  }

  void match_in_order(const Nodes& from, const Nodes& to) {
    const bool guessed = from.size() > 1 || to.size() > 1;
    for (std::size_t k = 0; k < std::min(from.size(), to.size()); ++k) pair(from[k], to[k], guessed);
  }

  /// Nodes of one name.
  void match_group(const Nodes& from, const Nodes& all_to) {
    const Nodes to = free_targets(all_to);
    if (from.size() == 1 && to.size() == 1) return pair(from[0], to[0], false);
    std::map<int, std::pair<Nodes, Nodes>> by_path;
    for (const int s : from) by_path[from_.path[at(s)]].first.push_back(s);
    for (const int t : to) by_path[to_.path[at(t)]].second.push_back(t);
    for (const auto& [path, both] : by_path) match_in_order(both.first, both.second);
    match_upwards(free_sources(from), free_targets(to));
  }

  int names_in_common(int s, int t) const {
    int out = 0;
    for (; out < k_most_names && s >= 0 && t >= 0 && from_.name[at(s)] == to_.name[at(t)]; ++out)
      s = from_.above[at(s)], t = to_.above[at(t)];
    return out;
  }

  void match_upwards(const Nodes& from, const Nodes& to) {
    if (from.size() * to.size() > k_most_pairs) return match_in_order(from, to);
    std::map<int, std::vector<std::pair<int, int>>, std::greater<>> by_names;
    for (const int s : from)
      for (const int t : to) by_names[names_in_common(s, t)].emplace_back(s, t);
    for (auto& [names, pairs] : by_names) {
      std::erase_if(pairs, [&](const auto& p) { return out_.to[at(p.first)] >= 0 || taken_[at(p.second)]; });
      std::unordered_map<int, int> of_source, of_target;
      for (const auto& [s, t] : pairs) ++of_source[s], ++of_target[t];
      for (const auto& [s, t] : pairs)
        if (out_.to[at(s)] < 0 && !taken_[at(t)]) pair(s, t, of_source[s] > 1 || of_target[t] > 1);
    }
  }

  const Character &source_, &target_;
  std::unordered_map<std::string, int> numbers_;
  std::map<std::pair<int, int>, int> paths_;
  Tree from_, to_;
  NodeMatch out_;
  std::vector<char> taken_;  ///< by node of the target
};

}  // namespace

NodeMatch match_nodes(const Character& source, const Character& target) {
  return Matcher(source, target).match();
}

}  // namespace ft::inline io
