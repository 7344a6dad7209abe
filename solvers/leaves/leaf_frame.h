// What is known of a frame of leaves, and what is counted in it. Between leaves_solver.cpp and leaf_flight.cpp.
#pragma once

#include "solvers/leaves/leaf_contact.h"
#include "solvers/leaves/leaves_solver.h"

namespace ft::inline solvers {

struct LeavesSolver::Frame {
  double t0 = 0, t1 = 0;  ///< s
  bool has_wind = false;
  std::vector<std::unique_ptr<AirNow>> air;  ///< at the ends of the slices
};

struct LeavesSolver::Tally {
  int crossings = 0, inside = 0, awake = 0, brought_out = 0, longest = 0;
  int afloat = 0;
  double steps = 0, energy = 0, deepest = 0, fastest = 0;
  bool finite = true;
  /// What leaves do to each body and ground in each slice, about the world's origin [N s]; empty: nothing.
  std::vector<Wrench> impulses{};

  Tally operator+(const Tally& b) const {
    std::vector<Wrench> both = impulses.empty() ? b.impulses : impulses;
    if (!impulses.empty() && !b.impulses.empty())
      for (std::size_t i = 0; i < both.size(); ++i) both[i] += b.impulses[i];
    return {crossings + b.crossings,
            inside + b.inside,
            awake + b.awake,
            brought_out + b.brought_out,
            std::max(longest, b.longest),
            afloat + b.afloat,
            steps + b.steps,
            energy + b.energy,
            std::max(deepest, b.deepest),
            std::max(fastest, b.fastest),
            finite && b.finite,
            std::move(both)};
  }
};

/// What a leaf touched in its last step.
struct LeavesSolver::Touch {
  std::vector<Wrench>* impulses = nullptr;  ///< as in Tally: filled, and sized when there are any
  bool lies = false;                        ///< against something
  bool moves = false;                       ///< that moves in this frame
};

inline double lowest_friction(const LeavesSetup& setup) {
  double least = std::numeric_limits<double>::infinity();
  for (const LeafObstacle& o : setup.bodies) least = std::min(least, o.friction);
  for (const LeafGround& g : setup.grounds) least = std::min(least, g.friction);
  return std::isfinite(least) ? least : 0.5;
}

}  // namespace ft::inline solvers
