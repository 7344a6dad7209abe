// Floating bodies meet one another (float_meeting.h), walls, the floor and skins that pass, so that nothing passes
// through: one after another in the order of the list. Skins are their vertices.
// Approximated: a ball smaller than a skin's triangles may slip between its vertices.
#pragma once

#include <span>

#include "solvers/water/pond/float_dynamics.h"

namespace ft::inline solvers {

struct PoolBounds {
  double size_x = 0, size_z = 0, depth = 0;  ///< m
};

/// Points of a driven skin at an instant, pool coordinates.
struct SkinPoints {
  Box box;
  std::vector<Vec3> places, velocities;
};

/// Moves and turns velocities; pushes on skins: forces on them are added to their impulses [N s].
void solve_contacts(std::span<const FloatModel> models, const PoolBounds& pool, std::span<const SkinPoints> skins,
                    Floats& floats, std::span<Vec3> skin_impulses, FloatLosses& losses);

/// How deep two bodies of a setup lie in one another by their spheres, <= 0 where they do not [m].
double overlap(const FloatShape& a, const RigidPose& pose_a, const FloatShape& b, const RigidPose& pose_b);

}  // namespace ft::inline solvers
