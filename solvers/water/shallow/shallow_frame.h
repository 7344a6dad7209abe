// The steps of one frame: how long the whole's are and which patch takes shorter ones, and what a patch's step does.
// For shallow_*.cpp only.
#pragma once

#include "solvers/water/shallow/shallow_scratch.h"

namespace ft::inline solvers {

class ShallowFrame {
 public:
  /// driven: all of them, of which the scratch has what may meet the water; they have to stay.
  ShallowFrame(const ShallowSetup& setup, std::span<const FloatingHull> floats, ShallowScratch& scratch,
               std::span<const DrivenBody> driven, double frame_time, std::uint64_t number);
  /// Takes away the water in whose place driven bodies stand at the frame's start; how much [m3].
  double make_room();
  void go();
  ShallowReport report();
  double outflow() const { return outflow_; }

 private:
  StepPlan plan() const;
  CellBox near_box(double dt, double top, double& speed) const;
  /// One long step; false: water came too near the patch's rim, nothing has changed, `plan` is shorter now.
  bool step(StepPlan& plan);
  /// All steps of the patch in a long one; false as above, after `elapsed` [s].
  bool step_patch(const StepPlan& plan, bool alone, double& elapsed);
  void place_bodies(double share);
  void step_bodies(double dt, double share1);
  void add_forces(double dt);

  const ShallowSetup& setup_;
  std::span<const FloatingHull> models_;
  ShallowScratch& s_;
  FlowLaws laws_;
  NearLaws near_;
  DropletBodies met_;
  double frame_time_, time_ = 0, outflow_ = 0, patch_outflow_ = 0, patch_speed_ = 0, body_speed_ = 0;
  std::uint64_t number_;
  std::vector<Vec6> impulse_;
  std::vector<Wrench> peak_;
  ShallowReport report_;
};

}  // namespace ft::inline solvers
