// In which order the energies visit their elements: sorted along a space-filling curve, in chunks of equal size, chunks
// coloured so that two of one colour share no vertex. Chunks of a colour may run at the same time and add straight into
// the result; every entry receives its terms in an order that does not depend on the number of threads. For membrane
// and bending. Elements of a chunk come in groups of k_lanes, for vector instructions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "baker/core/parallel.h"
#include "baker/core/types.h"

namespace ft::inline solvers {

inline constexpr int k_lanes = 8;

/// Elements are in slots, k_lanes of them a group; what is over in the last group is padding.
struct ElementSchedule {
  std::size_t count = 0;                  ///< of elements
  std::vector<std::vector<int>> colours;  ///< chunks of each colour
  std::size_t group_count() const { return block_count(count, k_lanes); }
  /// Elements of a group.
  std::size_t used(std::size_t group) const { return std::min<std::size_t>(k_lanes, count - group * k_lanes); }
};

/// Groups of one chunk.
inline constexpr std::size_t k_chunk_groups = 32;

/// vertices: corners per element, one element after the other; -1 entries are skipped. element_of_slot: which element
/// each slot holds.
ElementSchedule make_element_schedule(std::span<const int> vertices, std::size_t corners, std::span<const Vec3> rest,
                                      std::vector<int>& element_of_slot);

template <std::size_t Corners>
ElementSchedule make_element_schedule(const std::vector<std::array<int, Corners>>& stencils, std::span<const Vec3> rest,
                                      std::vector<int>& element_of_slot) {
  return make_element_schedule({stencils.empty() ? nullptr : stencils[0].data(), Corners * stencils.size()}, Corners,
                               rest, element_of_slot);
}

/// body(first group, end group) for every chunk, colour after colour.
template <class Body>
void for_each_chunk(const ElementSchedule& schedule, Body&& body) {
  const std::size_t groups = schedule.group_count();
  for (const std::vector<int>& chunks : schedule.colours)
    parallel_tasks(chunks.size(), [&](std::size_t i) {
      const std::size_t begin = static_cast<std::size_t>(chunks[i]) * k_chunk_groups;
      body(begin, begin + k_chunk_groups < groups ? begin + k_chunk_groups : groups);
    });
}

/// Sum of body(first group, end group) over the chunks, in their order.
template <class Body>
double sum_over_chunks(const ElementSchedule& schedule, Body&& body) {
  return parallel_sum(schedule.group_count(), k_chunk_groups, 0.0, body);
}

}  // namespace ft::inline solvers
