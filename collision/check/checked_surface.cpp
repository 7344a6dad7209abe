#include "collision/check/checked_surface.h"

#include <algorithm>

namespace ft::inline collision {

CheckedSurface::CheckedSurface(std::span<const Triangle> triangles)
    : triangles_(triangles), owned_(triangles.size(), 0) {
  std::vector<std::pair<Edge, int>> all;
  all.reserve(3 * triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = triangles[i][k], b = triangles[i][(k + 1) % 3];
      all.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(3 * i + k)});
    }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size();) {
    int uses = 0, sum = 0;  // of the edge; upwards counts 1, downwards -1
    const std::size_t first = i;
    for (; i < all.size() && all[i].first == all[first].first; ++i, ++uses) {
      const auto corner = static_cast<std::size_t>(all[i].second % 3);
      sum += triangles[at(all[i].second / 3)][corner] == all[i].first[0] ? 1 : -1;
    }
    closed_ = closed_ && uses == 2 && sum == 0;
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i == 0 || all[i].first != all[i - 1].first)
      owned_[at(all[i].second / 3)] |= static_cast<unsigned char>(1 << (all[i].second % 3));
}

void CheckedSurface::move(std::span<const Vec3> positions) {
  positions_ = positions;
  if (tree_.empty() && !triangles_.empty())
    tree_ = TriangleTree(positions, triangles_);
  else if (!triangles_.empty())
    tree_.refit(positions, triangles_);
}

}  // namespace ft::inline collision
