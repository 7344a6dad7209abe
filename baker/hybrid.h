// The hybrid pass: before its secondaries are baked, a prop meets their stand-ins and yields to them. What comes out is
// its adjusted track, by which the secondaries are then baked one-way.
#pragma once

#include <string>
#include <vector>

#include "baker/prop.h"
#include "solvers/standins/standin.h"

namespace ft {

struct HybridPass {
  RigidTrack track;                 ///< adjusted
  std::vector<std::string> names;   ///< of the secondaries that were stood in for
  Wrench largest;                   ///< of a frame's mean, with the largest force [N]
  double largest_displacement = 0;  ///< m
  double work = 0;                  ///< of all stand-ins [J]
  std::vector<std::string> notes;   ///< a stand-in that never touches

  /// What it came to, in a line.
  std::string text(const std::string& primary) const;
};

/// Whether any secondary of the primary is hybrid.
bool is_hybrid(const Shot& shot, const std::string& primary);

/// Over the frames of the shot. Refused: a prop without mass, stand-ins that make no sense.
Result<HybridPass> hybrid_pass(const Shot& shot, const Prop& prop);

/// The stand-in that a shot file's table means, in world units.
Result<StandInSpec> stand_in_spec(const StandInKeys& keys, const Shot& shot);

}  // namespace ft
