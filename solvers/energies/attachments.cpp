#include "solvers/energies/attachments.h"

#include "baker/core/check.h"

namespace ft::inline solvers {

namespace {

std::vector<Cord> cords_of(std::span<const AttachPoint> points) {
  std::vector<Cord> out;
  for (const AttachPoint& p : points) {
    CHECK(p.stiffness > 0 && p.max_pull > 0 && p.length >= 0);
    out.push_back({{p.vertex, p.triangle[0], p.triangle[1], p.triangle[2]},
                   {1, -p.weight[0], -p.weight[1], -p.weight[2]},
                   p.length,
                   p.stiffness,
                   p.max_pull});
  }
  return out;
}

}  // namespace

Attachments::Attachments(const ClothTopology& topology)
    : Cords(cords_of(topology.attachments)), points_(topology.attachments) {}

void Attachments::begin_step(const StepContext& context) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double share = points_[i].hold.share(context.time);
    cords_[i].stiffness = share * points_[i].stiffness;
    cords_[i].limit = share * points_[i].max_pull;
  }
}

}  // namespace ft::inline solvers
