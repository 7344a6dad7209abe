// For large lists: frees what containers hold before they go out of scope, and lets them grow with little to spare.
// Caution: `list = {}` assigns an empty list, and a vector keeps its room for the next one.
#pragma once

#include <cstddef>
#include <vector>

namespace ft {

/// Empties the containers and frees their room.
template <class... Containers>
void give_back(Containers&... containers) {
  ((containers = Containers()), ...);
}

/// Room for `count` entries in a list that grows bit by bit and is too large to have room for twice as many: for an
/// eighth more where there is not enough.
template <class T>
void reserve_sparingly(std::vector<T>& list, std::size_t count) {
  if (count > list.capacity()) list.reserve(count + count / 8);
}

}  // namespace ft
