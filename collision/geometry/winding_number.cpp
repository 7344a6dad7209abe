// See winding_number.h.
#include "collision/geometry/winding_number.h"

#include <cmath>
#include <numbers>

#include "baker/core/check.h"

namespace ft::inline collision {
namespace {

/// How far a dipole tree is trusted: within `doubt` of one half it is asked again with more triangles taken singly, at
/// last with all of them. The doubts are twice the largest errors met, or more (see the header).
struct Trust {
  double farness;
  double doubt;
};
constexpr Trust k_trust[] = {{2, 0.2}, {4, 0.04}, {8, 4e-3}};

/// Solid angle of a triangle [sr], positive from behind. 0 where p is on its plane beside it, or on an edge.
double solid_angle(const Vec3& p, const Vec3& i, const Vec3& j, const Vec3& k) {
  const Vec3 a = i - p, b = j - p, c = k - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

double solid_angle(const Vec3& p, const Triangle& t, std::span<const Vec3> x) {
  return solid_angle(p, x[at(t[0])], x[at(t[1])], x[at(t[2])]);
}

}  // namespace

double winding_number(const Vec3& p, std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += solid_angle(p, t, positions);
  return sum / (4 * std::numbers::pi);
}

WindingTree::WindingTree(const TriangleTree& tree, std::span<const Vec3> positions, std::span<const Triangle> triangles)
    : tree_(tree), positions_(positions), triangles_(triangles), dipoles_(tree.nodes().size()) {
  CHECK(tree.empty() || !tree.nodes().empty());
  std::vector<double> sizes(dipoles_.size(), 0.0);   // of the areas, whichever way they face [m2]
  for (std::size_t n = dipoles_.size(); n-- > 0;) {  // children have larger indices than parents
    const TriangleTree::Node& node = tree.nodes()[n];
    Dipole& d = dipoles_[n];
    Vec3 moment = Vec3::Zero();
    const auto add = [&](const Vec3& area, const Vec3& centre, double size) {
      d.area += area;
      moment += size * centre;
      sizes[n] += size;
    };
    if (node.count > 0) {
      for (int k = 0; k < node.count; ++k) {
        const Triangle& t = triangles[at(tree.order()[at(node.first + k)])];
        const Vec3 &a = positions[at(t[0])], &b = positions[at(t[1])], &c = positions[at(t[2])];
        const Vec3 area = 0.5 * (b - a).cross(c - a);
        add(area, (a + b + c) / 3, area.norm());
      }
    } else {
      for (const std::size_t child : {n + 1, at(node.first)})
        add(dipoles_[child].area, dipoles_[child].centre, sizes[child]);
    }
    const Vec3 lo(node.box.lo[0], node.box.lo[1], node.box.lo[2]), hi(node.box.hi[0], node.box.hi[1], node.box.hi[2]);
    d.centre = sizes[n] > 0 ? (moment / sizes[n]).eval() : (0.5 * (lo + hi)).eval();
    d.radius = (hi - d.centre).cwiseMax(d.centre - lo).norm();
  }
}

double WindingTree::about(const Vec3& p, double farness) const {
  if (dipoles_.empty()) return 0;
  double sum = 0;
  std::size_t stack[96];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::size_t n = stack[--top];
    const Dipole& d = dipoles_[n];
    const Vec3 to = d.centre - p;
    const double distance2 = to.squaredNorm(), reach = farness * d.radius;
    if (distance2 > reach * reach) {
      sum += d.area.dot(to) / (distance2 * std::sqrt(distance2));
      continue;
    }
    const TriangleTree::Node& node = tree_.nodes()[n];
    if (node.count == 0) {
      stack[top++] = at(node.first);
      stack[top++] = n + 1;
      continue;
    }
    for (int k = 0; k < node.count; ++k)
      sum += solid_angle(p, triangles_[at(tree_.order()[at(node.first + k)])], positions_);
  }
  return sum / (4 * std::numbers::pi);
}

bool WindingTree::is_inside(const Vec3& p) const {
  for (const Trust& trust : k_trust) {
    const double w = std::abs(about(p, trust.farness));
    if (std::abs(w - 0.5) > trust.doubt) return w > 0.5;
  }
  return std::abs(winding_number(p, positions_, triangles_)) > 0.5;
}

}  // namespace ft::inline collision
