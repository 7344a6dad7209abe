// See nearby_triangles.h.
#include "collision/body/nearby_triangles.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

namespace ft::inline collision {
namespace {

/// Room for the rounding of coordinates up to some metres from the centre to single precision [m].
constexpr float k_rounding = 2e-6f;
constexpr float k_far = 1e12f;  ///< m

/// Whether a comparison of lanes holds in one of them.
template <class Answers>
bool any(const Answers& answers) {
  std::uint64_t words[sizeof(Answers) / 8];
  std::memcpy(words, &answers, sizeof(Answers));
  std::uint64_t all = 0;
  for (const std::uint64_t word : words) all |= word;
  return all != 0;
}

}  // namespace

void NearbyTriangles::begin(const TreeBox& around) {
  around_ = around;
  for (int k = 0; k < 3; ++k) centre_[k] = 0.5 * (double(around.lo[k]) + around.hi[k]);
  boxes_.clear();
  triangle_.clear();
}

void NearbyTriangles::add(const TriangleTree& tree, std::span<const Vec3> positions,
                          std::span<const Triangle> triangles) {
  tree.for_each_near(around_, [&](int index) {
    const Triangle& t = triangles[at(index)];
    const Vec3 &a = positions[at(t[0])], &b = positions[at(t[1])], &c = positions[at(t[2])];
    const Vec3f lo = (a.cwiseMin(b).cwiseMin(c) - centre_).cast<float>();
    const Vec3f hi = (a.cwiseMax(b).cwiseMax(c) - centre_).cast<float>();
    const std::size_t lane = triangle_.size() % k_lanes;
    if (lane == 0) {
      Boxes& fresh = boxes_.emplace_back();
      for (int k = 0; k < 3; ++k) fresh.lo[k] = Lanes{} + k_far, fresh.hi[k] = Lanes{} - k_far;
    }
    Boxes& boxes = boxes_.back();
    for (int k = 0; k < 3; ++k) boxes.lo[k][lane] = lo[k] - k_rounding, boxes.hi[k][lane] = hi[k] + k_rounding;
    triangle_.push_back(index);
  });
}

TriangleTree::Hit NearbyTriangles::closest(const Vec3& p, double reach, std::span<const Vec3> positions,
                                           std::span<const Triangle> triangles) {
  TriangleTree::Hit hit;
  hit.closest.squared_distance = reach * reach;
  if (triangle_.empty()) return hit;
  const Vec3f q = (p - centre_).cast<float>();
  distance2_.resize(boxes_.size());
  const Lanes zero = {};
  Lanes least = zero + std::numeric_limits<float>::infinity();
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    Lanes sum = zero;
    for (int k = 0; k < 3; ++k) {
      const Lanes below = boxes_[b].lo[k] - q[k], above = q[k] - boxes_[b].hi[k];
      const Lanes outside = below > above ? below : above;
      const Lanes d = outside > zero ? outside : zero;
      sum += d * d;
    }
    least = sum < least ? sum : least;
    distance2_[b] = sum;
  }
  // First the triangle whose box is nearest, then whatever can still be nearer than what was found.
  float nearest = least[0];
  for (std::size_t l = 1; l < k_lanes; ++l) nearest = std::min(nearest, least[l]);
  const auto bound = [&] { return static_cast<float>(hit.closest.squared_distance) * (1 + 2e-5f); };
  if (nearest > bound()) return hit;
  std::size_t first = 0;
  while (distance2_[first / k_lanes][first % k_lanes] != nearest) ++first;
  const auto look_at = [&](std::size_t i) {
    const Triangle& t = triangles[at(triangle_[i])];
    TriangleTree::improve(hit, closest_on_triangle(p, positions[at(t[0])], positions[at(t[1])], positions[at(t[2])]),
                          triangle_[i]);
  };
  look_at(first);
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const Lanes d = distance2_[b];
    if (!any(d <= zero + bound())) continue;
    for (std::size_t l = 0; l < k_lanes; ++l)
      if (const std::size_t i = b * k_lanes + l; i != first && d[l] <= bound()) look_at(i);
  }
  return hit;
}

}  // namespace ft::inline collision
