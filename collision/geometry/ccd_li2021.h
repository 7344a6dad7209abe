// Additive continuous collision detection (Li, Kaufman, Jiang 2021, "Codimensional Incremental Potential Contact",
// section 5): conservative, never misses; a needless hit is only counted. Double precision, in a frame local to the
// pair. For the advance of the body with a carried cloth, where all four vertices may move.
#pragma once

#include <array>

#include "collision/geometry/pair_geometry.h"

namespace ft::inline collision {

struct CcdSettings {
  double gap_kept = 0.1;      ///< share of the starting distance that is kept [1]
  double floor = 1e-5;        ///< distance that is always kept when the start has it [m]
  int max_iterations = 1000;  ///< then the time reached so far is given, which is safe
};

/// Largest t in [0, 1] such that moving every vertex from x to x + t dx keeps the pair apart; 1 when it never meets. A
/// pair that touches at the start has t = 0, also when it parts from there.
double ccd_time(PairKind kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& dx,
                const CcdSettings& settings = {});

}  // namespace ft::inline collision
