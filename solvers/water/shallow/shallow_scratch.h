// What a frame of shallow water works with and forgets, and how its states are read. For shallow_*.cpp only.
#pragma once

#include "solvers/water/driven_near.h"
#include "solvers/water/droplet_flight.h"
#include "solvers/water/droplet_numbers.h"
#include "solvers/water/float_motion.h"
#include "solvers/water/shallow/patch.h"
#include "solvers/water/shallow/shallow_solver.h"
#include "solvers/water/shallow/splash.h"

namespace ft::inline solvers {

/// Ground under more than this is wet [m].
inline constexpr double k_wet_depth = 1e-5;

inline NearLaws near_laws(const ShallowSetup& s) {
  return {s.gravity, s.density, s.contact_pressure / (s.density * s.gravity)};
}

/// A long step, and the rectangle that takes it in shorter ones.
struct StepPlan {
  double dt = 0;
  CellBox box;
};

struct ShallowScratch {
  Flow flow;
  Patch patch;
  NearWater near;
  std::vector<double> speeds, patch_speeds;  ///< of tiles
  double fastest_body = 0;                   ///< of driven bodies near the water [m/s]
  std::vector<DrivenNear> driven;
  std::vector<FloatState> floats;
  std::vector<std::vector<Vec3>> float_places;
  std::vector<Droplet> droplets;
  std::vector<NearBody> bodies;  ///< driven ones, then floating ones
  std::vector<double> u1, w1, qx1, qz1;
  std::uint64_t next_id = 1, step = 0;
};

}  // namespace ft::inline solvers
