#include "solvers/water/pond/float_contact.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

/// Of one body: what an impulse at a place changes.
struct Side {
  const FloatModel* model = nullptr;
  RigidMotion* motion = nullptr;
  MovedBody moved() const { return {&model->mass, motion}; }
};

/// Against what moves by itself with a velocity; returns the impulse on the body. normal: towards the body.
Vec3 meet_fixed(Side side, const Vec3& place, const Vec3& normal, double depth, const Vec3& velocity,
                FloatLosses& losses) {
  side.motion->pose.position += depth * normal;
  const double approach = (side.motion->velocity_at(place) - velocity).dot(normal);
  if (approach >= 0) return Vec3::Zero();
  MovedBody body = side.moved();
  const double before = body.kinetic();
  const Vec3 impulse =
      (-(1 + bounce_of(approach, side.model->restitution)) * approach / body.softness(place, normal)) * normal;
  body.push(place, impulse);
  losses.contact += before - body.kinetic();
  return impulse;
}

void meet_walls(Side side, const PoolBounds& pool, FloatLosses& losses) {
  const FloatShape& s = side.model->shape;
  const auto plane = [&](const Vec3& normal, double offset) {
    if (side.motion->pose.position.dot(normal) - offset > 1.2 * s.contact.reach) return;
    double depth = 0;
    Vec3 place;
    for (const Vec3& c : s.contact.centres) {
      const Vec3 p = side.motion->pose * c;
      const double d = s.contact.radius - (p.dot(normal) - offset);
      if (d > depth) depth = d, place = p - s.contact.radius * normal;
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
  reach.inflate(1.2 * s.contact.reach);
  if (!reach.overlaps(skin.box)) return;
  for (const Vec3& c : s.contact.centres) {
    const Vec3 centre = side.motion->pose * c;
    double depth = 0;
    std::size_t found = 0;
    for (std::size_t v = 0; v < skin.places.size(); ++v) {
      const double square = (centre - skin.places[v]).squaredNorm();
      if (square >= s.contact.radius * s.contact.radius) continue;
      const double d = s.contact.radius - std::sqrt(square);
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
  return deepest(a.contact, pose_a, b.contact, pose_b).depth;
}

void solve_contacts(std::span<const FloatModel> models, const PoolBounds& pool, std::span<const SkinPoints> skins,
                    Floats& floats, std::span<Vec3> skin_impulses, FloatLosses& losses) {
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t a = 0; a < models.size(); ++a)
      for (std::size_t b = a + 1; b < models.size(); ++b)
        losses.contact +=
            meet({&models[a].mass, &floats.motion[a]}, models[a].shape.contact, {&models[b].mass, &floats.motion[b]},
                 models[b].shape.contact, std::min(models[a].restitution, models[b].restitution));
    for (std::size_t a = 0; a < models.size(); ++a) {
      for (std::size_t k = 0; k < skins.size(); ++k)
        meet_skin({&models[a], &floats.motion[a]}, skins[k], skin_impulses[k], losses);
      meet_walls({&models[a], &floats.motion[a]}, pool, losses);
    }
  }
}

}  // namespace ft::inline solvers
