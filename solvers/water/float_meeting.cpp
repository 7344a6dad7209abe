// See float_meeting.h.
#include "solvers/water/float_meeting.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "baker/core/volume.h"

namespace ft::inline solvers {
namespace {

constexpr double k_bounce_speed = 0.1;  ///< slower meetings do not bounce [m/s]
/// Vertices of a ball lie this near to one radius, in shares of it, and are at least so many.
constexpr double k_round = 1e-6;
constexpr std::size_t k_round_vertices = 18;

/// Spheres that fill a box.
void fill(const Box& box, ContactSpheres& out) {
  const Vec3 size = box.size();
  const double radius = std::max(0.5 * size.minCoeff(), 0.08 * size.maxCoeff());
  std::array<int, 3> count{};
  for (int a = 0; a < 3; ++a)
    count[at(a)] = std::max(1, static_cast<int>(std::ceil((size[a] - 2 * radius) / (1.2 * radius))) + 1);
  out.radius = radius;
  const auto place = [&](int a, int i) {
    const double free = std::max(size[a] - 2 * radius, 0.0);
    return box.lo[a] + 0.5 * (size[a] - free) + (count[at(a)] > 1 ? free * i / (count[at(a)] - 1) : 0.0);
  };
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k) out.centres.push_back(Vec3(place(0, i), place(1, j), place(2, k)));
}

}  // namespace

double ball_radius(const FloatingBody& body) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const Vec3& p : body.positions) most = std::max(most, p.norm()), least = std::min(least, p.norm());
  if (!(most - least <= k_round * most) || body.positions.size() < k_round_vertices) return 0;
  double volume = 0;
  for (const Triangle& t : body.triangles)
    volume += body.positions[at(t[0])].dot(body.positions[at(t[1])].cross(body.positions[at(t[2])]));
  return std::cbrt(volume / 6 * 3 / (4 * std::numbers::pi));
}

ContactSpheres contact_spheres(const FloatingBody& body) {
  ContactSpheres out;
  for (const Vec3& p : body.positions) out.reach = std::max(out.reach, p.norm());
  if (const double ball = ball_radius(body); ball > 0) {
    out.centres = {Vec3::Zero()};
    out.radius = ball;
  } else {
    fill(bounds(body.positions), out);
  }
  return out;
}

Meeting deepest(const ContactSpheres& a, const RigidPose& pose_a, const ContactSpheres& b, const RigidPose& pose_b) {
  Meeting out;
  const double radii = a.radius + b.radius;
  for (const Vec3& in_a : a.centres)
    for (const Vec3& in_b : b.centres) {
      const Vec3 pa = pose_a * in_a, way = pa - pose_b * in_b;
      const double far = way.norm();
      if (radii - far <= out.depth) continue;
      out.depth = radii - far;
      out.normal = far > 1e-12 ? Vec3(way / far) : Vec3::UnitY();
      out.place = pa - a.radius * out.normal;
    }
  return out;
}

Mat3 MovedBody::turned_inverse() const {
  const Mat3 turn = motion->pose.rotation.toRotationMatrix();
  return turn * mass->inertia.inverse() * turn.transpose();
}

double MovedBody::softness(const Vec3& place, const Vec3& normal) const {
  const Vec3 arm = (place - motion->pose.position).cross(normal);
  return 1 / (mass->mass + added) + arm.dot(turned_inverse() * arm);
}

void MovedBody::push(const Vec3& place, const Vec3& impulse) {
  motion->velocity += impulse / (mass->mass + added);
  motion->spin += turned_inverse() * (place - motion->pose.position).cross(impulse);
}

double MovedBody::kinetic() const {
  const Mat3 turn = motion->pose.rotation.toRotationMatrix();
  const Vec3 spin = turn.transpose() * motion->spin;
  return 0.5 * (mass->mass + added) * motion->velocity.squaredNorm() + 0.5 * spin.dot(mass->inertia * spin);
}

double bounce_of(double approach, double restitution) {
  return approach < -k_bounce_speed ? restitution : 0;
}

double meet(MovedBody a, const ContactSpheres& spheres_a, MovedBody b, const ContactSpheres& spheres_b,
            double restitution) {
  const double reach = spheres_a.reach + spheres_b.reach;
  if ((a.motion->pose.position - b.motion->pose.position).squaredNorm() > 1.44 * reach * reach) return 0;
  const Meeting m = deepest(spheres_a, a.motion->pose, spheres_b, b.motion->pose);
  if (m.depth <= 0) return 0;
  const double share = (b.mass->mass + b.added) / (a.mass->mass + a.added + (b.mass->mass + b.added));
  a.motion->pose.position += m.depth * share * m.normal;
  b.motion->pose.position -= m.depth * (1 - share) * m.normal;
  const double approach = (a.motion->velocity_at(m.place) - b.motion->velocity_at(m.place)).dot(m.normal);
  if (approach >= 0) return 0;
  const double before = a.kinetic() + b.kinetic();
  const Vec3 impulse = (-(1 + bounce_of(approach, restitution)) * approach /
                        (a.softness(m.place, m.normal) + b.softness(m.place, m.normal))) *
                       m.normal;
  a.push(m.place, impulse);
  b.push(m.place, -impulse);
  return before - a.kinetic() - b.kinetic();
}

}  // namespace ft::inline solvers
