#include "baker/core/types.h"

namespace ft {

Box bounds(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& p : points) box.include(p);
  return box;
}

bool all_finite(std::span<const Vec3> points) {
  for (const Vec3& p : points)
    if (!p.allFinite()) return false;
  return true;
}

}  // namespace ft
