// See driven_near.h.
#include "solvers/water/driven_near.h"

#include <algorithm>

namespace ft::inline solvers {

DrivenNear::DrivenNear(const DrivenBody& body, double below) {
  std::vector<int> number(body.from.size(), -1);
  for (const Triangle& t : body.triangles) {
    double lowest = body.from[at(t[0])].y();
    for (const int v : t) lowest = std::min({lowest, body.from[at(v)].y(), body.to[at(v)].y()});
    if (lowest >= below) continue;
    Triangle kept;
    for (std::size_t k = 0; k < 3; ++k) {
      int& n = number[at(t[k])];
      if (n < 0) {
        n = static_cast<int>(from.size());
        from.push_back(body.from[at(t[k])]);
        to.push_back(body.to[at(t[k])]);
      }
      kept[k] = n;
    }
    triangles.push_back(kept);
  }
  places = from;
}

void DrivenNear::place(double share) {
  for (std::size_t v = 0; v < from.size(); ++v) places[v] = from[v] + share * (to[v] - from[v]);
}

Box DrivenNear::box_below(double height, double share0, double share1, double& farthest) const {
  Box box;
  for (const Triangle& t : triangles) {
    Vec3 start[3], end[3];
    double lowest = height;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = from[at(t[k])], d = to[at(t[k])] - a;
      start[k] = a + share0 * d, end[k] = a + share1 * d;
      lowest = std::min({lowest, start[k].y(), end[k].y()});
    }
    if (lowest >= height) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      box.include(start[k]);
      box.include(end[k]);
      farthest = std::max(farthest, (to[at(t[k])] - from[at(t[k])]).norm());
    }
  }
  return box;
}

}  // namespace ft::inline solvers
