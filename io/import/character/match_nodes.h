// Nodes of one file found in another by their names; where names repeat, by the names above them.
#pragma once

#include <vector>

#include "io/import/character/character.h"

namespace ft::inline io {

struct NodeMatch {
  std::vector<int> to;         ///< for each node of the source one of the target, no node twice; -1: none
  std::vector<char> in_order;  ///< for each node of the source: the names above do not tell it from another one either
};

/// A node goes to the one that has its name, else its name without a namespace or a path. Of several it is the one with
/// the same path from the root, made of the names that both files have; else the one with which it shares the most
/// names upwards; else, which is a guess, the next in the file's order.
NodeMatch match_nodes(const Character& source, const Character& target);

}  // namespace ft::inline io
