// All pairs of features whose boxes meet, by looking at every pair: what the pair finder has to find.
#pragma once

#include <vector>

#include "collision/broad_phase/contact_pairs.h"
#include "collision/broad_phase/vertex_box.h"

namespace ft::test {

/// Cloth vertices come first, then those of the collider.
struct PairScene {
  int cloth_vertices = 0, collider_vertices = 0;
  std::vector<Triangle> cloth, collider;
  std::vector<VertexBox> boxes;  ///< per vertex; an inverted one is nowhere
};

/// Sorted as PairFinder's lists are. self: cloth against cloth too.
ContactPairs brute_force(const PairScene& scene, bool self);

}  // namespace ft::test
