// Where a Newton iteration goes: the solution of the linear system, truncated so that no pair crosses; where truncation
// spoils it, what is in its way becomes stiff, or is held, and the system is solved anew.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "baker/core/stopwatch.h"
#include "solvers/cloth/solve/implicit_step.h"
#include "solvers/cloth/solve/step_truncation.h"
#include "solvers/linear/linear_system.h"

namespace ft::inline solvers {

class NewtonDirection {
 public:
  /// What an iteration starts from; it has to stay until its end.
  struct Iteration {
    ContactPotential& contact;
    std::span<const Vec3> all;       ///< places of cloth and body [m]
    std::span<const Vec3> downhill;  ///< the potential's negative gradient, per cloth vertex [N]
    MotionBounds balls;
    StepTruncation::PairsSuffice pairs_suffice;  ///< may be empty
    const std::function<void()>& fill_system;    ///< fills system() with the Hessian anew
    Stopwatch& watch;
    StepResult& result;  ///< counts linear iterations and seconds, and says where a solution was not finite
  };

  explicit NewtonDirection(const ClothModel& model);
  /// To be filled with the Hessian before solve(). A large one is empty after it.
  LinearSystem& system() { return system_; }
  /// Before the first iteration of a step.
  void begin() { enough_ = 0; }
  /// The solution, without truncation, per cloth vertex [m].
  std::span<const Vec3> solve(const Iteration& iteration);
  /// What may be done of it [m]; fills the front of `trial`, cloth and body, with where that leads. The system may
  /// have springs in it then.
  std::span<const Vec3> truncate(const Iteration& iteration, std::span<Vec3> trial);
  /// Frees the direction, while the system is filled anew.
  void forget();
  /// Frees the system too, until the next step.
  void forget_all();

 private:
  void solve(const Iteration& iteration, std::span<const char> held);
  void cut_direction(const Iteration& iteration, std::span<Vec3> trial);
  bool is_spoiled(const Iteration& iteration) const;
  void refill(const Iteration& iteration, std::span<const PairTerm> springs);
  void add_springs_against(std::span<const PairObstacle> obstacles, std::vector<PairTerm>& springs) const;

  const ClothModel& model_;
  LinearSystem system_;
  StepTruncation truncation_;
  /// What the first solve of a step may leave, later ones may too: they have less to solve for, and what takes long
  /// [sqrt(J)].
  double enough_ = 0;
  std::vector<Vec3> direction_, cut_;
};

/// What the potential loses along a displacement, to the first order [J].
double descent(std::span<const Vec3> downhill, std::span<const Vec3> displacement);

}  // namespace ft::inline solvers
