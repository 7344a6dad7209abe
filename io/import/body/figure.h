// The figure in a skeleton: which joints are its pelvis, trunk, head, arms and legs. Found by the joints' names and
// their places in the hierarchy, never by where they are, so that it is there before any pose is.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/import/body/limbs.h"

namespace ft::inline io {

/// Nodes; -1 where none was found.
struct FigureLimb {
  int upper = -1, lower = -1, end = -1;  ///< hip, knee, ankle; shoulder, elbow, wrist
  Side side = Side::k_none;
  bool whole() const { return upper >= 0 && lower >= 0 && end >= 0; }
};

struct Figure {
  int base = -1;   ///< the lowest node above all arms and legs that were found
  int hips = -1;   ///< the lowest node above all legs
  int chest = -1;  ///< the lowest node above all arms
  int neck = -1, head = -1;
  std::vector<FigureLimb> legs, arms;
  bool has_trunk() const { return base >= 0 && legs.size() == 2 && (neck >= 0 || arms.size() == 2); }
  /// In words: "the knee of the left leg"; empty when the figure is complete.
  std::vector<std::string> missing() const;
};

/// Of the tree below `root`; -1: of all nodes. limb: limbs_by_name(), where it is known already.
Figure find_figure(const Character& character, int root = -1);
Figure find_figure(const Character& character, std::span<const Limb> limb, int root);

/// 1 for the nodes that are the skeleton's own: of every tree with a figure in it those from the figure's base down, of
/// others all. A root on the floor, references and cameras are none of it.
std::vector<char> figure_nodes(const Character& character, std::span<const Limb> limb);

}  // namespace ft::inline io
