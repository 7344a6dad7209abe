#include "collision/geometry/weld.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "baker/core/check.h"

namespace ft::inline collision {

std::vector<int> weld(std::span<const Vec3> bind, std::span<const int> part_of_vertex) {
  std::vector<int> order(bind.size()), representative(bind.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int v) {
    return std::array<double, 4>{bind[at(v)].x(), bind[at(v)].y(), bind[at(v)].z(), double(part_of_vertex[at(v)])};
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto u = key(a), v = key(b);
    return u < v || (u == v && a < b);
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    representative[at(order[i])] =
        i > 0 && key(order[i]) == key(order[i - 1]) ? representative[at(order[i - 1])] : order[i];
  return representative;
}

}  // namespace ft::inline collision
