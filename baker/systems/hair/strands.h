// Strands between guides: their roots spread over the triangles of neighbouring guides, their shapes mixed from those.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/core/trajectory.h"
#include "solvers/hair/hair_setup.h"

namespace ft::inline baker {

struct StrandsAsked {
  int count = 20000;
  double clumping = 0.5;          ///< of the way to the nearest guide, at the tip [1]; 0 evenly spread, 1 all on guides
  double length_variation = 0.1;  ///< up to so much of it a strand is shorter [1]
  double width = 80e-6;           ///< m
  std::uint64_t seed = 1;
};

/// On the scalp's bind pose. Guides whose combed shapes differ by half of their length from a neighbour's lie on
/// another side of a parting and are not mixed with it.
std::vector<BetweenStrand> strands_between(const StrandsAsked& asked, std::span<const HairStrand> guides,
                                           const Trajectory& scalp);

}  // namespace ft::inline baker
