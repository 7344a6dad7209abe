// The cavity of air behind a body that goes in fast: a stack of slices that open where its tail passes and close by the
// weight of the water around them,
//   (r^2)'' = -2 g max(depth, 1.5 r) / beta,  beta = 2,  (r^2)'(0) = 2 r alpha v
// (after Duez et al. 2007 and Aristoff and Bush 2009; constants are dials that look right, not fits). Its volume is
// pushed up around it as other volumes are. When it first closes, a jet stands up.
#pragma once

#include <span>
#include <vector>

#include "solvers/water/pond/pond_state.h"
#include "solvers/water/pond/skin_volume.h"
#include "solvers/water/pond/splash.h"

namespace ft::inline solvers {

/// A frame's events of driven bodies.
struct CavityEvents {
  std::vector<Throw> jets;
  double volume_change = 0;  ///< m3
};

/// A slice of time of one driven body between two states under water: its crown, and slices that its tail opens.
/// speed: downwards, of the skin at the surface or of its tail [m/s].
void cross_surface(const SkinUnderWater& from, const SkinUnderWater& to, double speed, double tail_speed, double time,
                   double body, const SplashSettings& settings, double density, Crossing& crossing,
                   std::vector<CavitySlice>& slices);

/// All slices over a time; closed ones go. Volumes that change go to the layers.
void close_cavities(double time, double gravity, double density, const SplashSettings& settings,
                    std::span<Crossing> crossings, std::vector<CavitySlice>& slices, VolumeLayers& layers,
                    CavityEvents& events, std::span<double> foam, const PondModes& modes);

}  // namespace ft::inline solvers
