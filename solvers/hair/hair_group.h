// What never changes of four strands, and what is around them in a step. Between the files of the solver.
#pragma once

#include "solvers/hair/hair_solver.h"

namespace ft::inline solvers {

struct HairSolver::Group {
  Rod<Lanes> rod;
};

/// Of a step, the same for all strands.
struct HairSolver::Step {
  double h = 0;        ///< s
  bool first = false;  ///< implicit Euler: there is no step of this length before
  double implicit() const { return first ? h : 2.0 / 3 * h; }       ///< x = y + implicit^2 a
  std::span<const RootFrame> roots_before, roots_now, roots_after;  ///< a step before its start; its start; its end
  const AirNow* air = nullptr;
  // Blocks of the state.
  double *x = nullptr, *x_before = nullptr, *v = nullptr, *v_before = nullptr, *m = nullptr, *tension = nullptr;
  int* iterations = nullptr;  ///< of each group
  int* unsettled = nullptr;
};

/// Scratch of a thread.
struct HairSolver::Work {
  RodStep<Lanes> step;
  RodPose<Lanes> pose, start;
  RodSurroundings<Lanes> around;
  RodStrains<Lanes> since;
  std::vector<Lanes> tension;
  std::vector<std::pair<int, int>> candidates;
  std::vector<Vec3> x, v, now, next;
};

/// Gap that a vertex keeps where it was combed nearer than that, or inside [m].
inline constexpr double k_least_reach = 2e-4;

}  // namespace ft::inline solvers
