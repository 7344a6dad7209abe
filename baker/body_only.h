// A primary that has no secondaries to be baked: nothing moves but the time. So that its adjusted motion is walked,
// cached and resumed as everything else.
#pragma once

#include "baker/systems/system.h"

namespace ft {

/// fps > 0.
std::unique_ptr<Solver> make_body_only(int first_frame, int preroll_frames, double fps);

class BodyGroup final : public SystemGroup {
 public:
  BodyGroup(std::size_t whom, int first_frame, int preroll_frames, double fps)
      : SystemGroup(whom), first_frame_(first_frame), preroll_frames_(preroll_frames), fps_(fps) {}
  std::string_view role() const override { return "body"; }
  Result<std::unique_ptr<Solver>> make_solver() override { return make_body_only(first_frame_, preroll_frames_, fps_); }
  std::vector<std::string> lines(const BakePlan&) const override { return {}; }

 private:
  int first_frame_, preroll_frames_;
  double fps_;
};

}  // namespace ft
