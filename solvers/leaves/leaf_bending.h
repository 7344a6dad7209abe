// How a leaf bends: two modes beside its motion as a plate. Its rib curls into an arc, and its two halves fold up or
// down about the rib. In either the mesh keeps its lengths along the rib and across.
//
// The modes move no centre of mass, and those of leaves alike on both sides do not turn it: so the plate flies as a
// rigid one does, and what bends it is what differs from place to place: the air on a leaf that turns, its own
// turning, and whatever it touches (leaf_contact.h, where an impulse moves, turns and bends at once). Elastic energy is
// that of a thin plate of one bending stiffness B in pure bending: B kappa^2 / 2 by area, kappa = curl / half length
// for the rib, fold / half width for the halves. For a strip that is 1.2 times the frequency of the exact first mode of
// a free beam, as a parabola in Rayleigh's quotient has it.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "solvers/leaves/leaf_shape.h"

namespace ft::inline solvers {

/// Of a mode [1], [1/s]: the curl of the rib, by which its ends are turned from its middle [rad]; the fold of the
/// halves beyond their fold at rest [rad]. Above 0: up.
using Modes = Eigen::Vector2d;

/// A leaf's modes never go beyond these [rad].
inline const Modes k_most_bent(1.2, 0.8);

/// What never changes.
struct LeafBending {
  std::vector<double> area_share;                  ///< of each vertex, of the leaf's area; they sum up to 1
  double rib_height = 0;                           ///< y of the rib, about the centre of mass [m]
  double half_length = 0, half_width = 0;          ///< m
  Eigen::Matrix2d mass = Eigen::Matrix2d::Zero();  ///< with the air's that goes along [kg m2]
  Modes stiffness = Modes::Zero();                 ///< N m/rad
  Modes damping = Modes::Zero();                   ///< N m s/rad
  double own_mass = 0;                             ///< of the leaf [kg]
  double fastest = 0;                              ///< of its frequencies [rad/s]
};

/// shape: to scale. bending: stiffness B [N m], > 0.
LeafBending bending_of(const LeafShape& shape, const PlateModel& plate, double bending);

/// The vertices of a bent leaf about its centre of mass, in its own axes [m].
void bend(const LeafBending& model, const LeafShape& shape, const Modes& bent, std::vector<Vec3>& out);

/// By how much a vertex moves with each mode, there: in pairs, in the leaf's own axes [m/rad].
void bend_directions(const LeafBending& model, const LeafShape& shape, const Modes& bent, std::vector<Vec3>& out);

/// What a leaf's surroundings do to its modes.
struct BendingLoad {
  Modes force = Modes::Zero();                        ///< N m
  Eigen::Matrix2d damping = Eigen::Matrix2d::Zero();  ///< by the air [N m s/rad]
};

/// Of the air and of its own turning. places, directions: as bend() and bend_directions() give them; air: past the
/// centre of mass, relative to it [m/s]; spin [rad/s]: all in the leaf's axes.
BendingLoad bending_load(const LeafBending& model, const LeafShape& shape, const PlateModel& plate,
                         std::span<const Vec3> places, std::span<const Vec3> directions, const Vec3& air,
                         const Vec3& spin);

/// A step of the modes' speeds, stable however long it is.
struct BendingStep {
  Modes speed = Modes::Zero();                         ///< after it [rad/s]
  Eigen::Matrix2d mobility = Eigen::Matrix2d::Zero();  ///< what an impulse in it adds to that [1/(kg m2)]
};
/// implicit: 0.5 keeps energy as well as steps can, 1 is for what touches something.
BendingStep step_bending(const LeafBending& model, const BendingLoad& load, double time, double implicit,
                         const Modes& bent, const Modes& speed);

/// In free flight, in as many steps as the leaf's frequencies ask for.
void advance_bending(const LeafBending& model, const LeafShape& shape, const PlateModel& plate, const Vec3& air,
                     const Vec3& spin, double time, Modes& bent, Modes& speed);

/// Adds a change, and stops at k_most_bent.
void bend_by(const Modes& change, Modes& bent, Modes& speed);

}  // namespace ft::inline solvers
