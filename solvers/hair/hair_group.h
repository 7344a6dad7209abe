// What is around four strands in a step, and scratch. Between the files of the solver.
#pragma once

#include "solvers/hair/hair_solver.h"

namespace ft::inline solvers {

/// Of a step, the same for all strands.
struct HairSolver::Step {
  double h = 0;        ///< s
  bool first = false;  ///< implicit Euler: there is no step of this length before
  std::span<const RootFrame> roots_before, roots_now, roots_after;  ///< a step before its start; its start; its end
  const AirNow* air = nullptr;
  std::span<const Vec3> push, flow;  ///< of the crowd, for each vertex without ghosts [m/s2, m/s]; empty: none
  // Blocks of the state.
  double *x = nullptr, *x_before = nullptr, *v = nullptr, *v_before = nullptr, *m = nullptr, *tension = nullptr;
  int* iterations = nullptr;  ///< of each group
  int* unsettled = nullptr;
  int* passages = nullptr;  ///< of segments through sheets, that were not kept back
};

/// What moves of one strand.
struct StrandNow {
  std::vector<Vec3> x, x_before, v, v_before, m;
  std::vector<double> tension;
};

/// A step of four strands, or a piece of one.
struct HairSolver::Piece {
  double h = 0;             ///< s
  bool first = false;       ///< implicit Euler: x = y + implicit^2 a
  double from = 0, to = 1;  ///< of the step
  double implicit() const { return first ? h : 2.0 / 3 * h; }
};

/// Scratch of a thread.
struct HairSolver::Work {
  RodStep<Lanes> step;
  RodPose<Lanes> pose, start;
  RodSurroundings<Lanes> around;
  std::vector<HairContact<Lanes>> contacts;  ///< of the whole step
  std::vector<V3<Lanes>> moved;              ///< how far each of their places goes in it [m]
  std::vector<SegmentContact<Lanes>> segments;
  std::vector<V3<Lanes>> segments_moved;
  RodStrains<Lanes> since;
  std::vector<Lanes> tension;
  std::vector<std::pair<int, int>> candidates;
  std::array<StrandNow, k_lanes> strands, settled;
};

/// Gap that a vertex keeps where it was combed nearer than that, or inside [m].
inline constexpr double k_least_reach = 2e-5;

/// Of a strand's edges without the ghost's, the last one twice: one for each vertex.
inline void add_directors(std::span<const Vec3> of_edges, std::vector<Vec3>& out) {
  out.insert(out.end(), of_edges.begin() + 1, of_edges.end());
  out.push_back(of_edges.back());
}

}  // namespace ft::inline solvers
