#include "solvers/energies/triangle_slots.h"

#include <limits>

#include "baker/core/check.h"
#include "solvers/energies/cloth_topology.h"

namespace ft::inline solvers {

const TriangleOrder& triangle_order(const ClothTopology& topology) {
  if (topology.order) return *topology.order;
  CHECK(topology.pieces.size() <= std::numeric_limits<std::uint16_t>::max());
  std::vector<Triangle> triangles;
  std::vector<std::size_t> index;
  for (std::size_t t = 0; t < topology.triangles.size(); ++t) {
    if (topology.rest_area[t] == 0) continue;
    triangles.push_back(topology.triangles[t]);
    index.push_back(t);
  }
  auto order = std::make_shared<TriangleOrder>();
  auto slots = std::make_shared<TriangleSlots>();
  std::vector<int> of_slot;
  slots->schedule = make_element_schedule(triangles, topology.rest, of_slot);
  slots->vertices = group_indices<3>(slots->schedule, [&](std::size_t slot) { return triangles[at(of_slot[slot])]; });
  slots->piece.reserve(of_slot.size() + k_lanes);
  order->triangle.reserve(of_slot.size());
  for (const int i : of_slot) {
    order->triangle.push_back(index[at(i)]);
    slots->piece.push_back(static_cast<std::uint16_t>(topology.triangle_piece[index[at(i)]]));
  }
  slots->piece.resize(slots->schedule.group_count() * k_lanes, 0);
  order->slots = std::move(slots);
  topology.order = std::move(order);
  return *topology.order;
}

}  // namespace ft::inline solvers
