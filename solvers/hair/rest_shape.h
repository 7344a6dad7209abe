// The rest shape that makes a groom stand still, exactly: what the artist combed is the equilibrium.
//
// From the tip to the root, vertex by vertex, the tension, the two bending moments and the twisting moment that carry
// what hangs below are the solution of a 4 x 4 system; the rest strains follow from the moments. O(n), and exact.
// What can be wrong then is stability, not statics: a strand may stand as a pencil does on its tip. Negative pivots of
// its Hessian, less w^2 times its mass, are modes that are slower than w or grow (Sylvester); bending and twisting
// stiffness are raised together, with the rest shape renewed, until there are none.
#pragma once

#include "solvers/hair/rod.h"

namespace ft::inline solvers {

/// Given forces on its vertices beside elasticity [N], gives the rod the rest shape (lengths, curvatures, twists) in
/// which `pose` is its equilibrium.
void make_rest_shape(Rod<double>& rod, const RodPose<double>& pose, std::span<const Vec3> forces);

/// Slowest mode that a strand shall have beside hanging ones [rad/s]: 70 % of that of a hanging chain of its length,
/// so that hair that hangs is never made stiffer.
double slowest_wanted(double length, double gravity);

/// Whether all modes of the pose, an equilibrium, are faster than `slowest` [rad/s]. The first `held` vertices beside
/// the ghost do not move.
bool is_stable(const Rod<double>& rod, const RodPose<double>& pose, double slowest, int held = 1);

/// Rest shape and, where it could not stand, stiffness. Returns by how much bending and twisting stiffness had to be
/// raised: 1 where it stands as it is, at most 2^12.
double stand_still(Rod<double>& rod, const RodPose<double>& pose, std::span<const Vec3> forces, double slowest,
                   int held = 1);

/// At a given factor of stiffness.
void stand_still_at(double factor, Rod<double>& rod, const RodPose<double>& pose, std::span<const Vec3> forces);

}  // namespace ft::inline solvers
