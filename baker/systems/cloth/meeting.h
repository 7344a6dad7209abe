// Which cloths are solved together and which primaries they meet. Everything may meet everything, unless the cloth's
// `meets` says otherwise; what is too far apart during the whole clip is solved apart, which costs less and gives the
// same. Decided from boxes of the clip alone. Cloth that is held always is nowhere farther from its wearer than its own
// size; of cloth that is not, it is assumed that it only falls, and drifts with the wind: cloth that is thrown far may
// fly past what it does not know.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "baker/plan/plan.h"
#include "baker/systems/cloth/cloth_spec.h"

namespace ft::inline baker {

/// Cloths that are solved together; indices into BakePlan::primaries, ascending.
struct Meeting {
  std::vector<std::size_t> wearers;  ///< whose cloths these are
  std::vector<std::size_t> bodies;   ///< what they may meet, the wearers among them
};

/// What decides about one cloth.
struct ClothReach {
  std::string name;
  std::size_t wearer = 0;
  Box start;                ///< where it starts [m]
  bool may_leave = false;   ///< nothing holds it to its wearer all the time
  std::vector<char> meets;  ///< per primary
};

/// Meetings in the order of their first wearer. primaries: all of the shot.
std::vector<Meeting> find_meetings(const Shot& shot, std::span<const PrimaryPlan> primaries,
                                   std::span<const ClothReach> cloths, double fastest_wind);

}  // namespace ft::inline baker
