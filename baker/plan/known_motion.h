// Solvers of what is known before the first frame: nothing has to be solved, only the time goes on. So that it is
// walked, cached and resumed as everything else.
#pragma once

#include "baker/systems/interface/system.h"

namespace ft::inline baker {

class KnownMotionSolver : public Solver {
 public:
  /// fps > 0.
  KnownMotionSolver(int first_frame, int preroll_frames, double fps);
  std::span<const Triangle> collider_triangles() const override { return {}; }
  void collider_positions(const State&, std::vector<Vec3>& positions) const override { positions.clear(); }
  State initial_state() const override;
  FrameReport advance_frame(State& state) override;

 protected:
  /// Adds what is measured in a frame of the shot, counted from 0.
  virtual void measure(std::size_t /*index*/, FrameReport& /*report*/) const {}

 private:
  int first_frame_, preroll_frames_;
  double fps_;
};

/// A primary that has no secondaries to be baked, and whose adjusted motion is cached.
class BodyGroup final : public SystemGroup {
 public:
  BodyGroup(std::size_t whom, int first_frame, int preroll_frames, double fps)
      : SystemGroup(whom), first_frame_(first_frame), preroll_frames_(preroll_frames), fps_(fps) {}
  std::string_view role() const override { return "body"; }
  Result<std::unique_ptr<Solver>> make_solver() override;
  std::vector<std::string> lines(const BakePlan&) const override { return {}; }

 private:
  int first_frame_, preroll_frames_;
  double fps_;
};

}  // namespace ft::inline baker
