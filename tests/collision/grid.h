// The triangles of a grid of n x n vertices, for sheets of all shapes.
#pragma once

#include <vector>

#include "baker/core/types.h"

namespace ft::test {

/// Two for every cell; vertices are numbered row by row from `first`.
inline void add_grid_triangles(int n, int first, std::vector<Triangle>& triangles) {
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int a = first + i * n + j;
      triangles.push_back({a, a + 1, a + n});
      triangles.push_back({a + 1, a + n + 1, a + n});
    }
}

}  // namespace ft::test
