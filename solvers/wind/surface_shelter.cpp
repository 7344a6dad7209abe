#include "solvers/wind/surface_shelter.h"

#include <array>
#include <cmath>
#include <numbers>

#include "collision/geometry/triangle_tree.h"

namespace ft::inline solvers {
namespace {

constexpr double k_recovery = 6;        ///< radii
constexpr double k_looked_for = 30;     ///< radii
constexpr double k_softness = 0.1;      ///< distance of the outer rays from the middle one, by the radius
constexpr double k_off_surface = 0.01;  ///< cloth on the body is not behind what it lies on [m]

/// Distance along a ray of length 1 to the first triangle beyond a start [m]; `most` where there is none.
class Rays {
 public:
  Rays(std::vector<Vec3> positions, const std::vector<Triangle>& triangles)
      : positions_(std::move(positions)), triangles_(triangles), tree_(positions_, triangles_) {}

  double first_hit(const Vec3& from, const Vec3& way, double most) const {
    const Vec3 inverse = way.cwiseInverse();
    double nearest = most;
    const auto nodes = tree_.nodes();
    std::vector<int> open{0};
    while (!open.empty()) {
      const int i = open.back();
      open.pop_back();
      const TriangleTree::Node& node = nodes[at(i)];
      if (!meets(node.box, from, inverse, nearest)) continue;
      for (int k = 0; k < node.count; ++k)
        nearest = std::min(nearest, hit(triangles_[at(tree_.order()[at(node.first + k)])], from, way, nearest));
      if (node.count > 0) continue;
      open.push_back(node.first);
      open.push_back(i + 1);
    }
    return nearest;
  }

 private:
  static bool meets(const TreeBox& box, const Vec3& from, const Vec3& inverse, double most) {
    double enter = 0, leave = most;
    for (int k = 0; k < 3; ++k) {
      if (!std::isfinite(inverse[k])) {
        if (from[k] < box.lo[k] || from[k] > box.hi[k]) return false;
        continue;
      }
      const double a = (box.lo[k] - from[k]) * inverse[k], b = (box.hi[k] - from[k]) * inverse[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
  }
  /// Moeller, Trumbore 1997.
  double hit(const Triangle& t, const Vec3& from, const Vec3& way, double most) const {
    const Vec3& a = positions_[at(t[0])];
    const Vec3 ab = positions_[at(t[1])] - a, ac = positions_[at(t[2])] - a, p = way.cross(ac);
    const double det = ab.dot(p);
    if (det == 0) return most;
    const Vec3 r = from - a, q = r.cross(ab);
    const double u = r.dot(p) / det, v = way.dot(q) / det, s = ac.dot(q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && s > k_off_surface ? s : most;
  }

  std::vector<Vec3> positions_;
  const std::vector<Triangle>& triangles_;
  TriangleTree tree_;
};

class SurfaceNow final : public Shelter::Now {
 public:
  SurfaceNow(std::vector<Vec3> positions, const std::vector<Triangle>& triangles, double radius)
      : rays_(std::move(positions), triangles), radius_(radius) {}

  double open(const Vec3& place, const Vec3& velocity) const override {
    const Vec3 way = -velocity.normalized();
    const Vec3 side = way.unitOrthogonal(), up = way.cross(side);
    const double most = k_looked_for * radius_, apart = k_softness * radius_;
    double blocked = 0;
    for (const Vec3& offset : std::array<Vec3, 5>{Vec3::Zero(), apart * side, -apart * side, apart * up, -apart * up}) {
      const double distance = rays_.first_hit(place + offset, way, most);
      if (distance >= most) continue;
      const double recovered = distance / (k_recovery * radius_);
      blocked += 1 / (1 + recovered * recovered) / 5;
    }
    return 1 - blocked;
  }

 private:
  Rays rays_;
  double radius_;
};

}  // namespace

SurfaceShelter::SurfaceShelter(std::shared_ptr<const Trajectory> body) : body_(std::move(body)) {
  const std::vector<Vec3> x = bind_pose_of(*body_);
  double area = 0;
  for (const Triangle& t : body_->surface().triangles)
    area += 0.5 * (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]).norm();
  radius_ = std::max(1e-3, std::sqrt(area / (4 * std::numbers::pi)));
}

std::unique_ptr<Shelter::Now> SurfaceShelter::at_time(double time) const {
  std::vector<Vec3> x(static_cast<std::size_t>(body_->surface().vertex_count()));
  body_->sample(time, x);
  return std::make_unique<SurfaceNow>(std::move(x), body_->surface().triangles, radius_);
}

}  // namespace ft::inline solvers
