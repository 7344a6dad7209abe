// One implicit step of a lockstep system: Newton on the whole potential until nothing moves any more, every iteration
// cut short where something would meet. The normal forces of friction are looked at anew until they, too, have settled.
#pragma once

#include <span>
#include <vector>

#include "solvers/lockstep/lockstep_contact.h"

namespace ft::inline solvers {

struct LockstepMotion {
  std::vector<Vec3> x, v, x_previous, v_previous;  ///< of the nodes
  double h_previous = 0;                           ///< s; 0: no history
};

struct LockstepStepReport {
  int newton_iterations = 0;
  double residual = 0;        ///< what the last iteration wanted to move [m]
  double missed = 0;          ///< how far a driven prop stayed behind its track [m]
  bool scenery_late = false;  ///< it has not come to the end of its way; where it is next it would be in the cords
  bool finite = true;
  bool settled = true;             ///< nothing wanted to move further in the end
  std::vector<Wrench> on_met;      ///< as LockstepContact::on_met()
  Vec3 hold_force = Vec3::Zero();  ///< on all held points [N]
  double effective_step = 0;       ///< what forces acted for, in the integrator's sense [s]
  double seconds_contact = 0, seconds_assembly = 0, seconds_linear = 0;
};

class LockstepStep {
 public:
  explicit LockstepStep(const LockstepModel& model);
  /// contact() has begun the step. driven: where the prop's nodes have to be at the end; empty: it moves by itself, or
  /// there is none.
  LockstepStepReport step(double end, double h, std::span<const Vec3> driven, LockstepMotion& motion);
  LockstepContact& contact() { return contact_; }
  /// Points that stood in the way of what is driven, of the last step.
  std::vector<LockstepContact::Blocked> blocking(std::span<const Vec3> x, bool prop_is_driven) const {
    return contact_.blocking(x, prop_is_driven, share_);
  }

 private:
  bool newton(LockstepStepReport& report);
  double value(std::span<const Vec3> x, double share) const;

  const LockstepModel& model_;
  LockstepContact contact_;
  CordElements elements_;
  NodeSystem system_;
  std::vector<Vec3> x_, y_, trial_, gradient_, direction_, last_;
  std::vector<double> weight_;
  double share_ = 1;         ///< of its way that the scenery has gone
  double scenery_cost_ = 0;  ///< of what is left of it, by its square [J]
  std::vector<NodeTerm> terms_;
};

}  // namespace ft::inline solvers
