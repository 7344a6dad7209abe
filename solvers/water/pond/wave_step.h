// One sweep over all waves of a pond: what bodies have pushed up or moved joins the surface, the surface drives the
// potential, the potential the surface, and bodies read the new water where they will be. One sweep is one step,
// because memory is what it costs; rows run in parallel, their sums are added in order.
//
// A source (a body, or a part of a large one) has a kernel phi for its volume, chi for its sidewards motion, both times
// exp(-k s) where its top lies s below the surface. The kernel that pushes water also weighs what pushes back, which is
// what keeps the energy.
#pragma once

#include <span>
#include <vector>

#include "solvers/water/pond/pond_modes.h"
#include "solvers/water/pond/wave_kernel.h"

namespace ft::inline solvers {

/// What a body reads: integrals over the surface with its kernels.
struct WaveProbe {
  double level = 0;                                       ///< <phi, eta> [m]
  double slope_x = 0, slope_z = 0;                        ///< <chi, gradient of eta> [1]
  double pull = 0;                                        ///< <k phi, eta>, of a body under water [1]
  double velocity_x = 0, velocity_y = 0, velocity_z = 0;  ///< of the water [m/s]
};

struct WaveSource {
  const KernelTable* kernel = nullptr;
  double x = 0, z = 0;            ///< where it pushes; pool coordinates [m]
  double top_depth = 0;           ///< s there, >= 0 [m]
  double volume = 0;              ///< that it displaces more than before [m3]
  double way_x = 0, way_z = 0;    ///< its volume and added mass over density, times its way [m4]
  double sinking = 0;             ///< the same, times the growth of s [m4]
  double next_x = 0, next_z = 0;  ///< where it reads
  double next_top_depth = 0;
};

struct WaveStepScratch {
  struct Source {
    Phases here, next;
    std::vector<double> deposit_cos, deposit_sin;
  };
  std::vector<Source> sources;
  std::vector<double> row_sums;
};

/// kick, drift: lengths of time for the potential and the surface [s]; both may be zero. probes: one for each source.
void step_waves(const PondModes& modes, std::span<const WaveSource> sources, double kick, double drift,
                std::span<double> eta, std::span<double> potential, std::span<WaveProbe> probes,
                WaveStepScratch& scratch);

}  // namespace ft::inline solvers
