#include "solvers/water/pond/float_contact.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

constexpr double k_bounce_speed = 0.1;  ///< slower meetings do not bounce [m/s]

/// Of one body: what an impulse at a place changes.
struct Side {
  const FloatModel* model = nullptr;
  RigidMotion* motion = nullptr;

  Mat3 turned_inverse() const {
    const Mat3 turn = motion->pose.rotation.toRotationMatrix();
    return turn * model->mass.inertia.inverse() * turn.transpose();
  }
  double softness(const Vec3& place, const Vec3& normal) const {
    const Vec3 arm = (place - motion->pose.position).cross(normal);
    return 1 / model->mass.mass + arm.dot(turned_inverse() * arm);
  }
  void push(const Vec3& place, const Vec3& impulse) {
    motion->velocity += impulse / model->mass.mass;
    motion->spin += turned_inverse() * (place - motion->pose.position).cross(impulse);
  }
  double kinetic() const {
    const Mat3 turn = motion->pose.rotation.toRotationMatrix();
    const Vec3 spin = turn.transpose() * motion->spin;
    return 0.5 * model->mass.mass * motion->velocity.squaredNorm() + 0.5 * spin.dot(model->mass.inertia * spin);
  }
};

/// Against what moves by itself with a velocity; returns the impulse on the body. normal: towards the body.
Vec3 meet_fixed(Side side, const Vec3& place, const Vec3& normal, double depth, const Vec3& velocity,
                FloatLosses& losses) {
  side.motion->pose.position += depth * normal;
  const double approach = (side.motion->velocity_at(place) - velocity).dot(normal);
  if (approach >= 0) return Vec3::Zero();
  const double bounce = approach < -k_bounce_speed ? side.model->restitution : 0;
  const double before = side.kinetic();
  const Vec3 impulse = (-(1 + bounce) * approach / side.softness(place, normal)) * normal;
  side.push(place, impulse);
  losses.contact += before - side.kinetic();
  return impulse;
}

struct Meeting {
  double depth = -std::numeric_limits<double>::infinity();
  Vec3 place = Vec3::Zero(), normal = Vec3::Zero();  ///< from b to a
};

Meeting deepest(const FloatShape& a, const RigidPose& pose_a, const FloatShape& b, const RigidPose& pose_b) {
  Meeting out;
  const double radii = a.contact_radius + b.contact_radius;
  for (const Vec3& in_a : a.contact_centres)
    for (const Vec3& in_b : b.contact_centres) {
      const Vec3 pa = pose_a * in_a, way = pa - pose_b * in_b;
      const double far = way.norm();
      if (radii - far <= out.depth) continue;
      out.depth = radii - far;
      out.normal = far > 1e-12 ? Vec3(way / far) : Vec3::UnitY();
      out.place = pa - a.contact_radius * out.normal;
    }
  return out;
}

void meet(Side a, Side b, FloatLosses& losses) {
  const double reach = a.model->shape.reach + b.model->shape.reach;
  if ((a.motion->pose.position - b.motion->pose.position).squaredNorm() > 1.44 * reach * reach) return;
  const Meeting m = deepest(a.model->shape, a.motion->pose, b.model->shape, b.motion->pose);
  if (m.depth <= 0) return;
  const double share = b.model->mass.mass / (a.model->mass.mass + b.model->mass.mass);
  a.motion->pose.position += m.depth * share * m.normal;
  b.motion->pose.position -= m.depth * (1 - share) * m.normal;
  const double approach = (a.motion->velocity_at(m.place) - b.motion->velocity_at(m.place)).dot(m.normal);
  if (approach >= 0) return;
  const double bounce = approach < -k_bounce_speed ? std::min(a.model->restitution, b.model->restitution) : 0;
  const double before = a.kinetic() + b.kinetic();
  const Vec3 impulse =
      (-(1 + bounce) * approach / (a.softness(m.place, m.normal) + b.softness(m.place, m.normal))) * m.normal;
  a.push(m.place, impulse);
  b.push(m.place, -impulse);
  losses.contact += before - a.kinetic() - b.kinetic();
}

void meet_walls(Side side, const PoolBounds& pool, FloatLosses& losses) {
  const FloatShape& s = side.model->shape;
  const auto plane = [&](const Vec3& normal, double offset) {
    if (side.motion->pose.position.dot(normal) - offset > 1.2 * s.reach) return;
    double depth = 0;
    Vec3 place;
    for (const Vec3& c : s.contact_centres) {
      const Vec3 p = side.motion->pose * c;
      const double d = s.contact_radius - (p.dot(normal) - offset);
      if (d > depth) depth = d, place = p - s.contact_radius * normal;
    }
    if (depth > 0) meet_fixed(side, place, normal, depth, Vec3::Zero(), losses);
  };
  plane(Vec3::UnitX(), 0);
  plane(-Vec3::UnitX(), -pool.size_x);
  plane(Vec3::UnitZ(), 0);
  plane(-Vec3::UnitZ(), -pool.size_z);
  plane(Vec3::UnitY(), -pool.depth);
}

void meet_skin(Side side, const SkinPoints& skin, Vec3& skin_impulse, FloatLosses& losses) {
  const FloatShape& s = side.model->shape;
  Box reach{side.motion->pose.position, side.motion->pose.position};
  reach.inflate(1.2 * s.reach);
  if (!reach.overlaps(skin.box)) return;
  for (const Vec3& c : s.contact_centres) {
    const Vec3 centre = side.motion->pose * c;
    double depth = 0;
    std::size_t found = 0;
    for (std::size_t v = 0; v < skin.places.size(); ++v) {
      const double square = (centre - skin.places[v]).squaredNorm();
      if (square >= s.contact_radius * s.contact_radius) continue;
      const double d = s.contact_radius - std::sqrt(square);
      if (d > depth) depth = d, found = v;
    }
    if (depth <= 0) continue;
    const Vec3 way = centre - skin.places[found];
    const Vec3 normal = way.norm() > 1e-12 ? Vec3(way.normalized()) : Vec3::UnitY();
    skin_impulse -= meet_fixed(side, skin.places[found], normal, depth, skin.velocities[found], losses);
  }
}

}  // namespace

double overlap(const FloatShape& a, const RigidPose& pose_a, const FloatShape& b, const RigidPose& pose_b) {
  return deepest(a, pose_a, b, pose_b).depth;
}

void solve_contacts(std::span<const FloatModel> models, const PoolBounds& pool, std::span<const SkinPoints> skins,
                    Floats& floats, std::span<Vec3> skin_impulses, FloatLosses& losses) {
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t a = 0; a < models.size(); ++a)
      for (std::size_t b = a + 1; b < models.size(); ++b)
        meet({&models[a], &floats.motion[a]}, {&models[b], &floats.motion[b]}, losses);
    for (std::size_t a = 0; a < models.size(); ++a) {
      for (std::size_t k = 0; k < skins.size(); ++k)
        meet_skin({&models[a], &floats.motion[a]}, skins[k], skin_impulses[k], losses);
      meet_walls({&models[a], &floats.motion[a]}, pool, losses);
    }
  }
}

}  // namespace ft::inline solvers
