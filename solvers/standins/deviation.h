// Deviation dynamics: how an imported motion yields to stand-ins. The clip is the true motion under all of its own
// forces (gravity, muscles, the ground), and these stay what they were, so that only the stand-ins' forces drive the
// deviation from it (x = x_clip + d, R = R_d R_clip, angular momentum L = L_clip + L_d):
//
//   M d'' = F - F_ref - M (omega^2 d + 2 zeta omega d'),    L_d' = T - T_ref - the same of the rotation
//
// Gravity is never added again: it is in the clip. F_ref is 0 where a stand-in is added; where it replaces the clip's
// support, F_ref is that support, the upright part of M (x_clip'' - g), while the clip stands on the stand-in.
// Horizontal ground forces of the clip stay: those stand-ins have no shear (O'Brien, Zordan & Hodgins 2000, section 4).
//
// Steps are exponential (Rosenbrock-Euler, Hochbruck & Ostermann 2010): exact where the forces are linear in place,
// velocity and time, whatever the stiffness, and halved where they are not (a touchdown), up to a bound of the error.
#pragma once

#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "solvers/standins/standin.h"

namespace ft::inline solvers {

/// What is imported: the motion of the centre of mass and the axes of the body at any time [s]. For a character that is
/// its whole mass, and the samples move against the axes.
struct YieldingBody {
  RigidMass mass;
  std::function<RigidMotion(double time)> motion;
  std::function<std::span<const ShapeSample>(double time)> shape;  ///< stays valid until it is asked again
};

/// A motion from samples dt [s] apart, the first at `start`: cubic in between, the spin turns from one to the next.
std::function<RigidMotion(double)> sampled_motion(double start, double dt, std::vector<RigidMotion> samples);

/// How the deviation comes back to the animation.
enum class Comeback {
  k_free,    ///< not at all: what was pushed drifts on, as a body in flight does
  k_spring,  ///< by a spring at all times
  k_window,  ///< by the same spring, which grows from nothing in the `window` after the last touch
  k_hold,    ///< its speed dies out after the last touch and the displacement stays
};

struct DeviationSettings {
  static constexpr double k_unlimited = std::numeric_limits<double>::infinity();

  double step = 1.0 / 240;  ///< longest step [s], at most 1/240
  double tolerance = 1e-5;  ///< error of a step [m/s, rad/s]; below it steps are not halved
  Comeback comeback = Comeback::k_free;
  double omega = 2 * std::numbers::pi;    ///< of the spring that brings it back [rad/s]; 1 Hz
  double zeta = 1;                        ///< its damping ratio; 1 comes back without overshoot
  double window = 0.5;                    ///< s
  double max_displacement = k_unlimited;  ///< m
  double max_acceleration = k_unlimited;  ///< by the stand-ins together [m/s2]
  Vec3 move_axes = Vec3::Ones();          ///< 0 where the clip's translation is kept, else 1; world axes
  Vec3 turn_axes = Vec3::Ones();          ///< the same of rotation
  Vec3 gravity = Vec3(0, -k_gravity, 0);  ///< that the clip was made under [m/s2]
};

/// All that changes.
struct DeviationState {
  double time = 0;                                               ///< s from the first frame of the shot
  RigidPose offset;                                              ///< d and R_d
  Vec3 velocity = Vec3::Zero();                                  ///< d' [m/s]
  Vec3 angular_momentum = Vec3::Zero();                          ///< L_d [kg m2/s]
  double last_touch = -std::numeric_limits<double>::infinity();  ///< s
  std::vector<char> touched;                                     ///< one for each stand-in: it has acted at least once

  bool is_zero() const;
};

/// Of a step, or of all steps up to a time.
struct DeviationStep {
  RigidMotion motion;  ///< adjusted, at the end; without a deviation the clip's to the last bit
  Wrench wrench;       ///< of all stand-ins, about the centre of mass, mean over the time
  double peak = 0;     ///< largest force at an end of a step [N]
  double work = 0;     ///< that they did on the body [J]
};

class Deviation {
 public:
  /// Refuses a body without mass, and steps and measures out of range.
  static Result<Deviation> make(YieldingBody body, std::vector<std::unique_ptr<StandIn>> stand_ins,
                                DeviationSettings settings);

  DeviationState start(double time) const;
  /// Goes on to a later time; fails when the deviation leaves all bounds.
  Result<DeviationStep> advance(DeviationState& state, double until) const;
  RigidMotion adjusted(const DeviationState& state) const { return adjusted(state, body_.motion(state.time)); }
  /// Names of the stand-ins that have never acted: misplaced ones, most likely.
  std::vector<std::string> untouched(const DeviationState& state) const;

 private:
  struct Trial;
  Deviation(YieldingBody body, std::vector<std::unique_ptr<StandIn>> stand_ins, DeviationSettings settings);
  RigidMotion adjusted(const DeviationState& state, const RigidMotion& clip) const;
  Vec3 turning(const DeviationState& state, const RigidMotion& clip) const;
  StandInForce force(const BodyState& body, std::vector<char>& touched) const;
  DeviationState drift(const DeviationState& from, const RigidMotion& clip, const RigidMotion& later, double h) const;
  std::optional<RigidMotion> carried(double upward, double middle) const;
  double comeback_share(const DeviationState& state, bool touching, double middle) const;
  Trial attempt(const DeviationState& from, double h) const;

  YieldingBody body_;
  std::vector<std::unique_ptr<StandIn>> stand_ins_;
  DeviationSettings settings_;
};

}  // namespace ft::inline solvers
