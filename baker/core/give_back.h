// Frees what containers hold before they go out of scope. Caution: `list = {}` assigns an empty list, and a vector
// keeps its room for the next one.
#pragma once

namespace ft {

/// Empties the containers and frees their room.
template <class... Containers>
void give_back(Containers&... containers) {
  ((containers = Containers()), ...);
}

}  // namespace ft
