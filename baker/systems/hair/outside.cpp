#include "baker/systems/hair/outside.h"

namespace ft::inline baker {
namespace {

constexpr int k_most_pushes = 12;  ///< in a fold, out of one side is into the other
constexpr double k_deepest = 0.1;  ///< from farther inside nothing comes out [m]
constexpr double k_slack = 1e-6;   ///< of the gap [m]

}  // namespace

Outside::Outside(std::span<const Vec3> positions, std::span<const Triangle> triangles)
    : positions_(positions),
      triangles_(triangles),
      tree_(positions, triangles),
      winding_(tree_, positions, triangles) {}

Outside::Push Outside::out(const Vec3& place, double gap) const {
  Push out{place, Vec3::Zero()};
  Vec3 sum = Vec3::Zero();  // of the normals so far
  for (int turn = 0; turn < k_most_pushes; ++turn) {
    const Vec3& p = out.place;
    const bool inside = winding_.is_inside(p);
    const double reach = inside ? k_deepest : gap - k_slack;
    TriangleTree::Hit hit;
    hit.closest.squared_distance = reach * reach;
    tree_.closest(p, positions_, triangles_, hit);
    if (hit.triangle < 0) break;
    const Triangle& t = triangles_[at(hit.triangle)];
    const Vec3 &a = positions_[at(t[0])], &b = positions_[at(t[1])], &c = positions_[at(t[2])];
    Vec3 normal = (inside ? -1 : 1) * (p - hit.closest.point);
    if (normal.norm() < 1e-9) normal = (b - a).cross(c - a);  // on the surface
    if (normal.isZero()) break;
    out.normal = normal.normalized();
    sum += out.normal;
    // In a fold that is narrower than two gaps the ways out of its sides lead to and fro; their mean leads out of it.
    const bool to_and_fro = turn >= 2 && sum.norm() > 0.2;
    out.place = to_and_fro ? (p + gap * sum.normalized()).eval() : (hit.closest.point + gap * out.normal).eval();
  }
  return out;
}

bool Outside::is_inside(const Vec3& place) const {
  return winding_.is_inside(place);
}

}  // namespace ft::inline baker
