// One [follow.NAME] in a plan: the primary's whole surface with what follows. The motion is known before the first
// frame; its solver only walks along it.
#pragma once

#include "baker/plan/plan.h"
#include "baker/systems/follow/follow_bones.h"

namespace ft::inline baker {

class FollowGroup final : public SystemGroup {
 public:
  using SystemGroup::SystemGroup;

  std::string name;
  std::shared_ptr<const Trajectory> motion;
  std::vector<double> lag;               ///< of each frame of the shot [m]
  std::vector<double> turn;              ///< of each frame [rad]; of joints
  std::vector<std::string> joints;       ///< their names; of vertices none
  std::vector<ChangedChannel> channels;  ///< of the joints, and of those of the sections before it
  std::size_t weighted = 0;              ///< vertices that follow
  int first_frame = 1, preroll = 0;
  double fps = 24;

  std::string_view role() const override { return "follow"; }
  Result<std::unique_ptr<Solver>> make_solver() override;
  std::vector<std::string> lines(const BakePlan& plan) const override;
  Result<std::vector<WrittenFile>> files(const BakePlan& plan, std::vector<std::string>& notes) const override;
};

/// The section's own group; it goes on from the last one of the same primary (null: there is none), so that what
/// follows adds up. Errors say where; notes go into the plan.
Result<std::unique_ptr<FollowGroup>> plan_follow(const Shot& shot, const FollowSpec& spec, std::size_t primary,
                                                 BakePlan& plan, const FollowGroup* before);

}  // namespace ft::inline baker
