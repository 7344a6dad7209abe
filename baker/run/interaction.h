// What the secondaries of a bake did to their primaries, over the frames in which they touched: the paper's table of
// force and effective acceleration, by which a coupling is chosen. The frames' own forces are in the manifest.
//
// One-way forces are upper bounds: a primary that would have yielded would have been pushed less.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "baker/plan/plan.h"
#include "baker/record/manifest.h"
#include "baker/record/report_json.h"

namespace ft::inline baker {

/// Of the frames in which there was contact.
struct Spread {
  double min = 0, mean = 0, max = 0;
};

struct Interaction {
  std::string primary;
  std::string secondary;        ///< empty: all of the primary's together, where there are several
  int frames = 0;               ///< with contact
  bool measured = false;        ///< its solver has told of its forces
  Spread force;                 ///< size of a frame's mean force [N]
  Spread torque;                ///< size of a frame's mean torque about the primary's centre of volume [N m]
  Spread acceleration;          ///< effective: |F| / M [m/s2]; all 0 where the mass is not known
  double peak = 0;              ///< largest force of a piece of a substep [N]; of all together, of their sum at most
  Vec3 impulse = Vec3::Zero();  ///< over all frames [N s]
};

/// Of the written frames: a row for each primary and each secondary that is on it or meets it; secondaries in the
/// manifest's order, each primary's sum behind its own.
std::vector<Interaction> interactions(const Manifest& manifest, const std::vector<PrimaryPlan>& primaries);

/// A table to be read, with the primaries' masses and where they come from; and what touches nothing.
std::vector<std::string> interaction_lines(const std::vector<Interaction>& interactions,
                                           const std::vector<PrimaryPlan>& primaries);
/// The secondaries that touch none of the primaries that they meet.
std::vector<std::string> untouched_lines(const std::vector<Interaction>& interactions);
Json to_json(const std::vector<Interaction>& interactions, const std::vector<PrimaryPlan>& primaries);

}  // namespace ft::inline baker
