// Mass of a primary: from the shot file, else from the volume of its body.
#pragma once

#include <string>

#include "baker/core/trajectory.h"
#include "io/shot/shot.h"

namespace ft::inline baker {

inline constexpr double k_body_density = 1010;  ///< of a person, between breaths [kg/m3]

struct PrimaryMass {
  double kilograms = 0;   ///< 0: not known
  bool given = false;     ///< in the shot file
  double volume = 0;      ///< m3, where it is not given
  double lids = 0;        ///< share of its area in the lids that close it for its volume
  double open_edges = 0;  ///< share of its edges at rims
  /// "46.56 kg, as given", "70.2 kg, from its volume of 69.5 dm3".
  std::string text() const;
  /// Of an open body, whose volume is that of what closes it; empty: it is all but closed, or its mass is given.
  std::string note() const;
};

/// Of a body without a volume (a sheet, wide open, or turned inside out) the mass is not known.
PrimaryMass primary_mass(const PrimarySpec& spec, const Trajectory& trajectory);

}  // namespace ft::inline baker
