#include "baker/core/teleport.h"

namespace ft {

const Teleport* teleport_into(std::span<const Teleport> teleports, int frame) {
  for (const Teleport& t : teleports)
    if (t.frame == frame) return &t;
  return nullptr;
}

void carry(const Teleport& teleport, std::span<Vec3> points) {
  for (Vec3& p : points) p = teleport.motion * p;
}

}  // namespace ft
