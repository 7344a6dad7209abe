// See nearby_leaves.h.
#include "collision/nearby_leaves.h"

#include <algorithm>

namespace ft {
namespace {

/// Room for the rounding of coordinates up to some metres from the centre to single precision [m].
constexpr float k_rounding = 2e-6f;

}  // namespace

void NearbyLeaves::begin(const Vec3& centre) {
  centre_ = centre;
  for (std::vector<float>* side : {&lo_[0], &lo_[1], &lo_[2], &hi_[0], &hi_[1], &hi_[2]}) side->clear();
  leaves_.clear();
}

void NearbyLeaves::add(const TriangleTree& tree, const TriangleTree::Node& leaf) {
  for (int k = 0; k < 3; ++k) {
    lo_[k].push_back(static_cast<float>(leaf.box.lo[k] - centre_[k]) - k_rounding);
    hi_[k].push_back(static_cast<float>(leaf.box.hi[k] - centre_[k]) + k_rounding);
  }
  leaves_.emplace_back(&tree, &leaf);
}

TriangleTree::Hit NearbyLeaves::closest(const Vec3& p, double reach, std::span<const Vec3> positions,
                                        std::span<const Triangle> triangles) {
  TriangleTree::Hit hit;
  hit.closest.squared_distance = reach * reach;
  const std::size_t count = leaves_.size();
  if (count == 0) return hit;
  const Vec3f q = (p - centre_).cast<float>();
  distance2_.resize(count);
  const float x = q.x(), y = q.y(), z = q.z();
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = std::max(std::max(lo_[0][i] - x, x - hi_[0][i]), 0.0f);
    const float dy = std::max(std::max(lo_[1][i] - y, y - hi_[1][i]), 0.0f);
    const float dz = std::max(std::max(lo_[2][i] - z, z - hi_[2][i]), 0.0f);
    distance2_[i] = dx * dx + dy * dy + dz * dz;
  }
  const auto nearest =
      static_cast<std::size_t>(std::min_element(distance2_.begin(), distance2_.end()) - distance2_.begin());
  const auto look_into = [&](std::size_t i) {
    if (distance2_[i] * (1 - 1e-5f) <= static_cast<float>(hit.closest.squared_distance) * (1 + 1e-6f))
      leaves_[i].first->closest_in_leaf(*leaves_[i].second, p, positions, triangles, hit);
  };
  look_into(nearest);
  for (std::size_t i = 0; i < count; ++i)
    if (i != nearest) look_into(i);
  return hit;
}

}  // namespace ft
