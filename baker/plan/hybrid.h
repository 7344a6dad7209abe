// The hybrid pass: before its secondaries are baked, a primary meets their stand-ins and yields to them. What comes out
// is its deviation from its motion, by which the secondaries are then baked one-way. Also of stand-ins alone, for what
// is not baked here.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/shot/shot.h"
#include "solvers/standins/deviation.h"
#include "solvers/standins/standin.h"

namespace ft::inline baker {

/// What the stand-ins did in the frame that ends here, and how far the primary is from its motion by then.
struct HybridFrame {
  int frame = 0;
  Wrench mean;       ///< about the centre of mass
  double peak = 0;   ///< largest force [N]
  double work = 0;   ///< J
  RigidPose offset;  ///< of the centre of mass [m], and about it
};

struct HybridPass {
  double mass = 0;  ///< kg
  DeviationSettings settings;
  double dt = 0;                    ///< between samples [s]
  std::vector<RigidMotion> motion;  ///< adjusted, from the first frame of the shot on
  std::vector<RigidPose> offsets;   ///< of the same samples
  std::vector<HybridFrame> frames;  ///< all of the shot
  std::vector<std::string> names;   ///< of the secondaries that were stood in for, or of the stand-ins
  Wrench largest;                   ///< of a frame's mean, with the largest force [N]
  double largest_displacement = 0;  ///< m
  double work = 0;                  ///< of all stand-ins [J]
  std::vector<std::string> notes;   ///< a stand-in that never touches

  /// What it came to, in a line.
  std::string text(const std::string& primary) const;
  /// That line, and the notes.
  std::vector<std::string> lines(const std::string& primary) const;
  /// Deviation at a time, between samples in a straight line; before the shot none, after it the last.
  RigidPose offset(double time) const;
};

/// The stand-ins that a primary meets: those of its hybrid secondaries, and those that are on it.
std::vector<const StandInKeys*> stand_ins_of(const Shot& shot, const std::string& primary);

/// Whether it meets any, or has a hybrid secondary.
bool is_hybrid(const Shot& shot, const std::string& primary);

/// Over the frames of the shot, in samples at most `longest_step` [s] apart. turn_axes: 0 where the body keeps its
/// clip's rotation. Refused: a primary without mass, stand-ins that make no sense.
Result<HybridPass> hybrid_pass(const Shot& shot, const PrimarySpec& spec, YieldingBody body, double longest_step,
                               const Vec3& turn_axes);

/// The stand-in that a shot file's table means, in world units.
Result<StandInSpec> stand_in_spec(const StandInKeys& keys, const Shot& shot);

}  // namespace ft::inline baker
