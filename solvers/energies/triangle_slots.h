// The triangles of cloth that carry something, in the order in which energies visit them (element_schedule.h). All
// energies of one topology have them in common.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "solvers/energies/element_schedule.h"
#include "solvers/energies/group_indices.h"

namespace ft::inline solvers {

struct ClothTopology;

struct TriangleSlots {
  ElementSchedule schedule;
  GroupIndices<3> vertices;
  std::vector<std::uint16_t> piece;  ///< of the topology, per slot, padding included

  const std::uint16_t* pieces(std::size_t group) const { return &piece[group * k_lanes]; }
};

/// While energies are built.
struct TriangleOrder {
  std::shared_ptr<const TriangleSlots> slots;
  std::vector<std::size_t> triangle;  ///< of the topology, per slot
};

/// Worked out once per topology, whose triangles must not change afterwards.
const TriangleOrder& triangle_order(const ClothTopology& topology);

}  // namespace ft::inline solvers
