#include "solvers/energies/seams.h"

#include <algorithm>

#include "baker/core/check.h"

namespace ft::inline solvers {
namespace {

std::vector<Cord> cords_of(std::span<const SeamPoint> points) {
  std::vector<Cord> out;
  for (const SeamPoint& p : points) {
    CHECK(p.stiffness > 0 && p.pull > 0 && p.hold > 0);
    out.push_back({{p.vertex, p.edge[0], p.edge[1], -1}, {1, p.place - 1, -p.place, 0}, 0, p.stiffness, p.hold});
  }
  return out;
}

}  // namespace

Seams::Seams(const ClothTopology& topology) : Cords(cords_of(topology.seams)), points_(topology.seams) {}

void Seams::begin_step(const StepContext& context) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const SeamPoint& p = points_[i];
    const double lasts = p.closed_at - p.opens_at;
    const double done = lasts > 0 ? (context.time - p.opens_at) / lasts : (context.time < p.closed_at ? 0.0 : 2.0);
    cords_[i].length = p.start_gap * std::clamp(1 - done, 0.0, 1.0);
    // After the seam has closed, its limit grows over as long a time as it took.
    cords_[i].limit = p.pull + (p.hold - p.pull) * std::clamp(done - 1, 0.0, 1.0);
  }
}

}  // namespace ft::inline solvers
