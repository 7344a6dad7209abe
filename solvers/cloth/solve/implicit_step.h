// One implicit step of the cloth with the body standing still: minimises
//   1/(2 (beta h)^2) |x - y|_M^2 + elasticity + contact + friction + pins
// by Newton's method with a positive definite Hessian, every displacement truncated so that no pair crosses, with
// energy backtracking as a safety net. Time integration: integrator.h.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "baker/core/wrench.h"
#include "collision/step_bound/common_motion.h"
#include "solvers/base/integrator.h"
#include "solvers/cloth/model/cloth_model.h"
#include "solvers/cloth/solve/way_out.h"
#include "solvers/linear/linear_system.h"

namespace ft::inline solvers {

struct StepInput {
  std::span<const Vec3> x_t0, v_t0, x_tm1, v_tm1, x_tm2, v_tm2;  ///< cloth
  double h = 0, h_previous = 0, h_older = 0;                     ///< s
  double time = 0;                                               ///< at the end [s]
  std::span<const Vec3> all_start;   ///< cloth and body at the start: slip is measured from here
  std::span<const Vec3> pin_target;  ///< per pin, at the end of the step
  std::span<const Vec3> pin_motion;  ///< per pin: how far its target moves in the step [m]
  MotionBounds balls;                ///< what each cloth vertex has to stay in; it starts inside
  std::span<const Vec3> push;        ///< acceleration of each cloth vertex besides gravity [m/s2]; empty: none
  std::span<const Pull> pulls;       ///< ways out of tangles
  double friction_share = 1;         ///< of all friction [1]
  const PairList* pairs = nullptr;   ///< complete within the slack, but for what pairs_suffice adds
  int newton_iterations = 3;         ///< at least, unless nothing moves; more where the cloth is still strained
  bool no_more = false;              ///< not even then
  /// Root mean square of what an iteration may still change the edges' lengths by at the end, after it is truncated and
  /// also before unless it is stuck, over their rest lengths [1].
  double settled_strain = 5e-3;
  /// Called when an iteration wants to take a vertex farther past its slack than enough_room: how far, per vertex,
  /// where the cloth is, and by what it wants to move [m]. It may give other balls that hold the places, and pairs
  /// behind those that are there; both are looked at again. May be empty.
  std::function<void(std::span<const double> missing, std::span<const Vec3> x, std::span<const Vec3> move)> more_room;
  double enough_room = 0;  ///< m
  /// Called with where an iteration is about to put the cloth, straight from where it is [m]: true where `pairs` holds
  /// all that can meet on the way. It may add behind them and return false: the way is looked at again. May be empty.
  std::function<bool(std::span<const Vec3> x)> pairs_suffice;
  /// Whether a part of such a way may end at x [m], which pairs_suffice has not seen. May be empty: all may.
  std::function<bool(std::span<const Vec3> x)> may_stop;
};

struct StepResult {
  int newton_iterations = 0, linear_iterations = 0;
  /// Of garments with attachments, the largest force that Newton's method has left over on one of them as a whole, by
  /// its weight [1]: the step has lost that much of its momentum, or made it. 0 without gravity.
  double lost_weight = 0;
  double last_move = 0;     ///< largest displacement of the last iteration [m]
  double smallest_gap = 0;  ///< m
  bool finite = true;
  /// Per garment, and of each per body of the setup: what it does to it at the end of the step, by contact, friction
  /// and pins; about the origin.
  std::vector<Wrench> on_body;
  double seconds_assembly = 0, seconds_linear = 0, seconds_contact = 0;
};

class ImplicitStep {
 public:
  explicit ImplicitStep(const ClothModel& model);
  ~ImplicitStep();
  /// all: carried cloth and body at the end of the step; the solve puts the cloth where it goes, and fills v with its
  /// velocities then, which may be where input.v_tm2 is: that is looked at in the beginning only, and written over in
  /// the meantime.
  StepResult solve(const StepInput& input, std::span<Vec3> all, std::span<Vec3> v);

 private:
  void measure_on_body(std::span<const Vec3> all, double inertia, StepResult& result);
  void measure_lost(std::span<const Vec3> all, double inertia, StepResult& result);
  std::vector<Wrench> told_by_contacts(std::span<const Vec3> all);
  template <class Counts>
  void add_pin_gradient(std::span<const Vec3> all, Counts&& counts);
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
  const ClothModel& model_;
};

}  // namespace ft::inline solvers
