#include "baker/plan/known_motion.h"

#include <limits>

#include "baker/core/check.h"

namespace ft::inline baker {

KnownMotionSolver::KnownMotionSolver(int first_frame, int preroll_frames, double fps)
    : first_frame_(first_frame), preroll_frames_(preroll_frames), fps_(fps) {
  CHECK(fps > 0 && preroll_frames >= 0);
}

State KnownMotionSolver::initial_state() const {
  State state;
  state.frame = first_frame_ - preroll_frames_;
  state.time = -preroll_frames_ / fps_;
  return state;
}

FrameReport KnownMotionSolver::advance_frame(State& state) {
  ++state.frame;
  state.time = (state.frame - first_frame_) / fps_;
  FrameReport report;
  report.frame = state.frame;
  report.smallest_gap = std::numeric_limits<double>::infinity();  // there is nothing to be near
  if (state.frame >= first_frame_) measure(at(state.frame - first_frame_), report);
  return report;
}

namespace {

class NoSystem final : public KnownMotionSolver {
 public:
  using KnownMotionSolver::KnownMotionSolver;
  int system_count() const override { return 0; }
  const Mesh& system_mesh(int) const override { return none_; }
  void system_positions(const State&, int, std::span<Vec3>) const override {}

 private:
  Mesh none_;
};

}  // namespace

Result<std::unique_ptr<Solver>> BodyGroup::make_solver() {
  return std::unique_ptr<Solver>(std::make_unique<NoSystem>(first_frame_, preroll_frames_, fps_));
}

}  // namespace ft::inline baker
