// The body at the ends of substeps, several worked out at the same time: one evaluation has little to do in parallel.
// Functions of the time alone, so that it does not matter which of them are there already.
#pragma once

#include <limits>
#include <vector>

#include "baker/core/teleport.h"
#include "solvers/cloth/model/moving_collider.h"

namespace ft::inline solvers {

/// The body at one instant [m].
struct BodyPose {
  std::vector<Vec3> drawn, feasible;
  std::vector<char> absent;  ///< per vertex of feasible: too deep in the body itself for cloth to meet it
};

/// A frame's motion of the body. Its ends are kept: a frame starts where the last one ended.
class BodyAhead {
 public:
  explicit BodyAhead(const MovingCollider* collider) : collider_(collider) {}

  /// Takes up a frame [s]. Without a collider nothing happens.
  void begin(double t0, double t1);
  /// Carries what stands at the frame's start to where the primary is cut to: between its ends the drawn surface runs
  /// straight then.
  void cut(const Teleport& teleport);

  /// The pose at a time, when it is the end of the frame; else null.
  const BodyPose* known(double time) const { return time == t1_ ? &end_ : nullptr; }
  const BodyPose& start() const { return start_; }
  const BodyPose& end() const { return end_; }
  /// The body when substep k of `substeps` has ended, k from 0. In order: what lies before it is forgotten.
  const BodyPose& after(int k, int substeps);

 private:
  void evaluate(int first, int count, int substeps);
  void fill(double time, BodyPose& pose) const;

  const MovingCollider* collider_;
  double t0_ = 0, t1_ = std::numeric_limits<double>::quiet_NaN();
  bool cut_ = false;
  BodyPose start_, end_;
  std::vector<BodyPose> ahead_;  ///< after substeps first_ .. first_ + count_ - 1 of substeps_
  int first_ = 0, count_ = 0, substeps_ = 0;
};

}  // namespace ft::inline solvers
