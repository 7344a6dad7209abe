// Rigid bodies in columns of water: weight, drag, added mass, what keeps them above the ground and inside the walls.
// The pressure of the water is its model's.
#pragma once

#include "solvers/water/float_meeting.h"
#include "solvers/water/hydrostatics.h"
#include "solvers/water/water_body.h"

namespace ft::inline solvers {

/// All that changes of a body, as it is kept in a state: 14 numbers.
struct FloatState {
  RigidMotion motion;
  double added_mass = 0;  ///< kg, while it is under water
};
inline constexpr std::size_t k_float_numbers = 14;
FloatState read_float(std::span<const double> numbers);
void write_float(const FloatState& state, std::span<double> numbers);

/// What never changes of a body.
struct FloatingHull {
  FloatingBody body;
  double volume = 0;     ///< m3
  double spin_drag = 0;  ///< torque by density and speed squared [m5]
  ContactSpheres contact;
};
FloatingHull float_model(const FloatingBody& body);
std::vector<const FloatingBody*> bodies_of(std::span<const FloatingHull> hulls);
std::vector<RigidPose> poses_of(std::span<const FloatState> floats);

void float_positions(const FloatingHull& model, const RigidPose& pose, std::vector<Vec3>& positions);
RigidPose moved(const RigidPose& pose, const Vec6& velocity, double dt);

/// How water stands around a body.
struct FloatSurroundings {
  bool any = false;
  double level = 0;              ///< m
  Vec3 velocity = Vec3::Zero();  ///< m/s
};

/// What a step does to a body without the water's pressure.
struct FloatStep {
  Mat6 mass = Mat6::Zero();  ///< with added mass; world axes, about its centre of mass
  Vec6 free = Vec6::Zero();  ///< its velocity and spin at the step's end
  Vec3 drag = Vec3::Zero();  ///< on it [N]
};

/// Sets the added mass of `state`, with the momentum kept; `positions` are those of its pose at the step's end.
FloatStep prepare_float(const FloatingHull& model, FloatState& state, std::span<const Vec3> positions,
                        const FloatSurroundings& water, double gravity, double density, double dt);

/// Bodies that overlap are moved apart and turned, one pair after another in the order of the list.
void meet_one_another(std::span<const FloatingHull> models, std::span<FloatState> floats);

/// The ground under columns: heights of cells, of which (i, k) is at first + i + row k.
struct GroundCells {
  double x = 0, z = 0;  ///< least, in the world [m]
  double cell = 0;      ///< m
  int nx = 0, nz = 0;
  std::span<const double> bed;  ///< m
  std::size_t first = 0, row = 0;
};

/// Ground and walls, as the bed of the water and the sides of its domain: velocity after a step of dt without a vertex
/// beyond them, friction included.
Vec6 keep_above(const GroundCells& ground, std::span<const Vec3> positions, const Vec3& about, const Mat6& mass,
                const Vec6& velocity, double dt);

}  // namespace ft::inline solvers
