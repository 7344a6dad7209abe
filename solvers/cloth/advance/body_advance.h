// One substep: the body advances with the cloth carried along, as far as conservative CCD allows; the cloth is then
// solved for with the body still; what is left of the substep follows in the same way. Where there is no room at all,
// what blocks the cloth is let go, the smaller one of several parts (absence.h), so that the walk never stops.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "solvers/cloth/model/cloth_motion.h"
#include "solvers/cloth/solve/forces_on_bodies.h"
#include "solvers/cloth/solve/implicit_step.h"

namespace ft::inline solvers {

/// What one substep knows of the outside.
struct SubstepInput {
  std::span<const Vec3> body_t0, body_t1;  ///< feasible collider at both ends
  std::span<const char> deep_t1;           ///< per vertex of it at the end: too deep in the body to be met
  std::span<const Vec3> pins_t0, pins_t1;  ///< pin targets at both ends
  std::span<const Vec3> push;              ///< as StepInput's [m/s2]
  double friction_share = 1;               ///< as StepInput's [1]
  double h = 0;                            ///< s
  double time_t0 = 0;                      ///< s
  double shortest = 0;       ///< pieces shorter than this [s] make the walk release, but for some, see k_last_shortest
  int earlier_releases = 0;  ///< of this frame: where there was no room, there is seldom more a moment later
  /// What it may cost (work_limit.h) before what blocks is let go at once and Newton's method does no more than it
  /// has to.
  double patience = std::numeric_limits<double>::infinity();
};

/// What the pieces of a substep add up to.
struct AdvanceReport {
  int pieces = 0, newton_iterations = 0, linear_iterations = 0;
  double work = 0;         ///< see work_limit.h
  bool impatient = false;  ///< SubstepInput::patience was over
  int releases = 0;        ///< times that something of the body was let go
  double lost_weight = 0;  ///< mean of StepResult::lost_weight over the substep
  double smallest_gap = 0;
  bool finite = true;
  std::vector<OnBody> on_body;  ///< per garment, and of each per body of the setup
  double seconds_candidates = 0, seconds_assembly = 0, seconds_linear = 0, seconds_contact = 0;
};

class BodyAdvance {
 public:
  explicit BodyAdvance(const ClothModel& model);
  ~BodyAdvance();
  AdvanceReport substep(const SubstepInput& input, ClothMotion& motion);

 private:
  struct Scratch;
  double plan(const ClothMotion& cloth, double h);
  void solve(const SubstepInput& in, double h, double end, bool shortened, ClothMotion& cloth, AdvanceReport& report);

  std::unique_ptr<Scratch> scratch_;
  const ClothModel& model_;
};

}  // namespace ft::inline solvers
