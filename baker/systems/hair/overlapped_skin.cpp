#include "baker/systems/hair/overlapped_skin.h"

#include "collision/check/penetration.h"

namespace ft::inline baker {
namespace {

/// Above skin at rest, where it is asked whether it lies open [m].
constexpr double k_above = 1e-4;

}  // namespace

OverlappedSkin::OverlappedSkin(std::span<const Vec3> rest, std::span<const Triangle> triangles)
    : rest_(rest.begin(), rest.end()),
      triangles_(triangles.begin(), triangles.end()),
      surface_(rest, triangles, std::vector<int>(rest.size(), 0), 1),
      tree_(rest_, triangles_) {}

bool OverlappedSkin::holds(const Vec3& point, const TriangleTree& tree, std::span<const Vec3> x) const {
  TriangleTree::Hit hit;
  tree.closest(point, x, triangles_, hit);
  const char all = 1;
  const auto answer = surface_.judge(point, hit, {&all, 1}, x);
  if (!answer || answer->distance < 0) return false;
  const Triangle& t = triangles_[at(hit.triangle)];
  const Vec3 &a = rest_[at(t[0])], &b = rest_[at(t[1])], &c = rest_[at(t[2])];
  const Vec3 above = (a + b + c) / 3 + k_above * (b - a).cross(c - a).normalized();
  return !rays_say_inside(above, tree_, rest_, triangles_);
}

}  // namespace ft::inline baker
