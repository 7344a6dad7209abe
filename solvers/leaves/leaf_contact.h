// Where one leaf meets bodies and grounds in a short step, and the impulses that keep it out of them.
//
// The leaf is its mesh where it is at the start of the step, the body its triangles where they are at the end of it:
// so a contact's gap holds what the body does, and a leaf that is run into is taken along. Looked at are vertices of
// the leaf against triangles (with an inside), vertices of the body against the leaf's triangles, and edges of the
// leaf against edges of the body that stick out (which have an outside, and so tell on which side the leaf belongs).
// Grounds are half-spaces and meet vertices only. The leaf is kept `margin` away, which is larger than what chords of a
// curved body and a step's turning can hide.
//
// The impulses are found leaf by leaf by projected Gauss-Seidel on velocities: no restitution, Coulomb's cone, twice:
// once for where the leaf goes, with what puts it right where it is too near, once for the velocity that it keeps,
// without.
#pragma once

#include <span>
#include <vector>

#include "solvers/leaves/leaf_bending.h"
#include "solvers/leaves/leaf_bodies.h"
#include "solvers/leaves/leaf_shape.h"
#include "solvers/leaves/leaf_water.h"

namespace ft::inline solvers {

struct LeafContact {
  Vec3 arm;        ///< from the leaf's centre of mass to where it touches, world [m]
  Vec3 normal;     ///< unit, out of the body
  Vec3 velocity;   ///< of the body there [m/s]
  double gap = 0;  ///< m, with the body at the step's end
  double friction = 0;
  bool moves = false;                    ///< the body does, in this frame
  int met = 0;                           ///< index of the body, or of the ground after all bodies; -1: water
  std::array<int, 3> vertices{0, 0, 0};  ///< of the leaf, whose place by these weights is the contact's
  Vec3 weights = Vec3::UnitX();
};

/// A triangle that a leaf may meet in a slice.
struct NearTriangle {
  int body = 0, triangle = 0;
};

/// Scratch of one thread.
struct ContactScratch {
  std::vector<NearTriangle> near;
  std::vector<LeafContact> contacts;
  std::vector<Vec3> rim;  ///< vertices of the leaf, world
  struct Local {
    std::array<Vec3, 3> x, step;  ///< at the step's end; what it goes in the step
    Vec3 normal;
    int body = 0, triangle = 0;
    Box box;
  };
  std::vector<Local> local;
  std::vector<std::pair<int, int>> corners, edges;  ///< body and vertex or edge, each once
  std::vector<Vec3> impulse, share, turn;
  std::vector<Vec3> own_places;  ///< of a leaf that bends: bend(), in its own axes
  std::vector<Vec3> directions;  ///< of a leaf that bends: bend_directions(), world
  std::vector<Vec3> bends;       ///< of each contact, in pairs: how it moves with the leaf's modes [m/rad]
};

/// All triangles that a leaf can meet which stays within `reach` of centre during a slice.
void find_near(const LeafBodies& bodies, int slice, const Vec3& centre, double reach, std::vector<NearTriangle>& out);

struct ContactStep {
  int slice = 0;
  double from = 0, to = 1;  ///< of the slice, straight [1]
  double time = 0;          ///< s
  double margin = 0;        ///< m
  double reach = 0;         ///< gaps beyond it are no contacts [m]
  double touch = 0;         ///< gaps below it are contacts with a ground, whatever the leaf does [m]
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  ///< of the leaf [m/s], [rad/s]
  double bending = 0;                                 ///< at most, of its vertices as it bends [m/s]
};

/// Contacts of the leaf whose vertices are scratch.rim, about `centre`, with scratch.near and the grounds.
void find_contacts(const LeafBodies& bodies, std::span<const LeafGround> grounds, const LeafShape& shape,
                   const ContactStep& step, const Vec3& centre, ContactScratch& scratch);

/// Adds those of the same leaf with the plane of the water under it, before the water has it.
void meet_water(const WaterPatch& water, const ContactStep& step, const Vec3& centre, ContactScratch& scratch);

struct LeafVelocity {
  Vec3 linear, angular;           ///< world
  Modes bending = Modes::Zero();  ///< of a leaf that bends
};
/// How impulses move a leaf.
struct LeafMobility {
  double inverse_mass = 0;
  Mat3 inverse_inertia = Mat3::Zero();             ///< world
  const Eigen::Matrix2d* inverse_modes = nullptr;  ///< of its modes, with scratch.directions; null: it is rigid
};
/// Returns the velocity for the step's way; `kept` the one to go on with. Whether any contact pushed is in `pushed`.
LeafVelocity solve_contacts(std::span<const LeafContact> contacts, const LeafMobility& leaf, double time, double margin,
                            const LeafVelocity& wanted, ContactScratch& scratch, LeafVelocity& kept, bool& pushed);

}  // namespace ft::inline solvers
