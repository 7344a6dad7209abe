// Which limb a joint belongs to (joint_names.h), and the chains of two bones (hip, knee, ankle; shoulder, elbow, wrist)
// that can be bent so that their end stays where it is.
#pragma once

#include <string>
#include <vector>

#include "io/import/body/joint_names.h"
#include "io/import/character/character.h"

namespace ft::inline io {

/// Of a BVH, under the name that the reader gave it.
bool is_end_site(const CharacterNode& node);

/// Whether a node is `ancestor` or below it.
bool is_within(const Character& character, int node, int ancestor);

/// One per node. End sites of a BVH are what they end.
std::vector<Limb> limbs_by_name(const Character& character);

/// Nodes of a chain, each above the next; others (twist bones) may lie between them.
struct LimbChain {
  int upper = -1, lower = -1, end = -1;  ///< hip, knee, ankle
};

/// All legs and arms that the names tell: a foot below a shin below a thigh, a hand below a forearm below an upper arm.
std::vector<LimbChain> find_limbs(const Character& character);

/// The chain of three named nodes. A name that does not exist or stands for several nodes, and nodes that are not one
/// above the other, are errors.
Result<LimbChain> find_limb(const Character& character, const std::string& upper, const std::string& lower,
                            const std::string& end);

}  // namespace ft::inline io
