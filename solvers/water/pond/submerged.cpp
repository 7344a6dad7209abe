// See float_shape.h: volume below a level by the divergence theorem. Triangles are clipped by the level; tetrahedra
// from a point in the level's plane need no lid.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/water/pond/float_shape.h"

namespace ft::inline solvers {
namespace {

constexpr double k_pi = std::numbers::pi;

Submerged submerged_ball(double radius, const Vec3& centre, double level) {
  Submerged out;
  const double t = std::clamp(level - (centre.y() - radius), 0.0, 2 * radius);
  out.volume = k_pi * t * t * (radius - t / 3);
  out.area = k_pi * t * (2 * radius - t);
  const double rest = 2 * radius - t;
  out.centre = centre - Vec3(0, 0.75 * rest * rest / (3 * radius - t), 0);
  out.top = centre.y() + radius;
  return out;
}

struct Sums {
  double volume = 0, area = 0;
  Vec3 moment = Vec3::Zero();
  /// Points about one in the plane.
  void tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double v = a.dot(b.cross(c)) / 6;
    volume += v;
    moment += 0.25 * v * (a + b + c);
  }
  /// Where the surface leaves the water, from p to q in its triangle's sense.
  void cut(const Vec3& p, const Vec3& q) { area -= 0.5 * (p.z() * q.x() - p.x() * q.z()); }
};

void clip(const std::array<Vec3, 3>& p, Sums& sums) {
  const int below = (p[0].y() < 0) + (p[1].y() < 0) + (p[2].y() < 0);
  if (below == 0) return;
  if (below == 3) return sums.tetrahedron(p[0], p[1], p[2]);
  // Turned so that the odd one comes first.
  std::size_t odd = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if ((p[i].y() < 0) == (below == 1)) odd = i;
  const Vec3 &a = p[odd], &b = p[(odd + 1) % 3], &c = p[(odd + 2) % 3];
  Vec3 ab = a + (a.y() / (a.y() - b.y())) * (b - a), ac = a + (a.y() / (a.y() - c.y())) * (c - a);
  ab.y() = 0, ac.y() = 0;
  if (below == 1) {
    sums.tetrahedron(a, ab, ac);
    sums.cut(ab, ac);
  } else {
    sums.tetrahedron(ab, b, c);
    sums.tetrahedron(ab, c, ac);
    sums.cut(ac, ab);
  }
}

}  // namespace

Submerged submerged(const FloatPart& part, const RigidPose& pose, double level) {
  if (part.ball_radius > 0) return submerged_ball(part.ball_radius, pose.position, level);
  const Mat3 turn = pose.rotation.toRotationMatrix();
  const Vec3 origin = turn * part.centre + pose.position;
  const Vec3 in_plane(origin.x(), level, origin.z());
  const Vec3 shift = pose.position - in_plane;
  Sums sums;
  double top = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 2 < part.corners.size(); i += 3) {
    std::array<Vec3, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = turn * part.corners[i + c] + shift;
      top = std::max(top, p[c].y());
    }
    clip(p, sums);
  }
  Submerged out;
  out.volume = std::clamp(sums.volume, 0.0, part.volume);
  out.area = std::max(sums.area, 0.0);
  out.centre = sums.volume > 1e-12 * part.volume ? Vec3(in_plane + sums.moment / sums.volume) : origin;
  out.top = top + level;
  return out;
}

}  // namespace ft::inline solvers
