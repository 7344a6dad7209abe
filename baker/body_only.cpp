#include "baker/body_only.h"

#include <limits>

#include "baker/core/check.h"

namespace ft {
namespace {

class BodyOnly final : public Solver {
 public:
  BodyOnly(int first_frame, int preroll_frames, double fps)
      : first_frame_(first_frame), preroll_frames_(preroll_frames), fps_(fps) {}
  int system_count() const override { return 0; }
  const Mesh& system_mesh(int) const override { return none_; }
  void system_positions(const State&, int, std::span<Vec3>) const override {}
  std::span<const Triangle> collider_triangles() const override { return {}; }
  void collider_positions(const State&, std::vector<Vec3>& positions) const override { positions.clear(); }
  State initial_state() const override {
    State state;
    state.frame = first_frame_ - preroll_frames_;
    state.time = -preroll_frames_ / fps_;
    return state;
  }
  FrameReport advance_frame(State& state) override {
    ++state.frame;
    state.time = (state.frame - first_frame_) / fps_;
    FrameReport report;
    report.frame = state.frame;
    report.smallest_gap = std::numeric_limits<double>::infinity();  // there is nothing to be near
    return report;
  }

 private:
  int first_frame_, preroll_frames_;
  double fps_;
  Mesh none_;
};

}  // namespace

std::unique_ptr<Solver> make_body_only(int first_frame, int preroll_frames, double fps) {
  CHECK(fps > 0 && preroll_frames >= 0);
  return std::make_unique<BodyOnly>(first_frame, preroll_frames, fps);
}

}  // namespace ft
