// Rigid bodies in shallow water: weight, drag, added mass, what keeps them above the ground and inside the walls. The
// pressure of the water is near_water.h's.
#pragma once

#include "solvers/water/shallow/hydrostatics.h"
#include "solvers/water/shallow/near_water.h"

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
struct ShallowFloatModel {
  FloatingBody body;
  double volume = 0;     ///< m3
  double spin_drag = 0;  ///< torque by density and speed squared [m5]
};
ShallowFloatModel float_model(const FloatingBody& body);

void float_positions(const ShallowFloatModel& model, const RigidPose& pose, std::vector<Vec3>& positions);
RigidPose moved(const RigidPose& pose, const Vec6& velocity, double dt);

/// How water stands around a body.
struct ShallowFloatWater {
  bool any = false;
  double level = 0;              ///< m
  Vec3 velocity = Vec3::Zero();  ///< m/s
};

/// Fills mass and v* of `near`, and the added mass of `state` with the momentum kept; `positions` are those of its pose
/// at the step's end. Returns the force of the drag on the body.
Vec3 prepare_float(const ShallowFloatModel& model, FloatState& state, std::span<const Vec3> positions,
                   const ShallowFloatWater& water, const NearLaws& laws, double dt, NearBody& near);

/// Ground and walls, as the bed of a flow and the sides of the domain: velocity after a step of dt without a vertex
/// beyond them, friction included.
Vec6 keep_above(const Flow& flow, double world_x, double world_z, const Box& walls, std::span<const Vec3> positions,
                const Vec3& about, const Mat6& mass, const Vec6& velocity, double dt);

}  // namespace ft::inline solvers
