#include "baker/systems/follow/follow_group.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/plan/known_motion.h"
#include "baker/plan/located.h"
#include "baker/plan/placed_trajectory.h"
#include "baker/systems/follow/follow_points.h"
#include "io/export/motion_files.h"
#include "io/shot/vertex_values.h"
#include "io/shot/words.h"

namespace ft::inline baker {
namespace {

class FollowSolver final : public KnownMotionSolver {
 public:
  FollowSolver(Mesh mesh, const FollowGroup& group)
      : KnownMotionSolver(group.first_frame, group.preroll, group.fps),
        mesh_(std::move(mesh)),
        motion_(group.motion),
        lag_(group.lag),
        turn_(group.turn) {}

  int system_count() const override { return 1; }
  const Mesh& system_mesh(int) const override { return mesh_; }
  void system_positions(const State& state, int, std::span<Vec3> positions) const override {
    motion_->sample(state.time, positions);
  }

 protected:
  void measure(std::size_t index, FrameReport& report) const override {
    if (index < lag_.size()) report.own["follow_lag"] = lag_[index];
    if (index < turn_.size()) report.own["follow_turn"] = turn_[index];
  }

 private:
  Mesh mesh_;
  std::shared_ptr<const Trajectory> motion_;
  std::vector<double> lag_, turn_;
};

/// After which the lag has forgotten how it began, to a twentieth [s].
double memory(const FollowSpec& spec) {
  const double omega = 2 * std::numbers::pi * spec.frequency, zeta = spec.damping_ratio;
  return 3 / (omega * (zeta < 1 ? zeta : zeta - std::sqrt(zeta * zeta - 1)));
}

Status plan_joints(const FollowSpec& spec, const PrimaryPlan& primary, const FollowTiming& timing,
                   const FollowGroup* before, FollowGroup& group) {
  if (!primary.character)
    return usage_error("\"" + primary.name + "\" has no joints", {},
                       "write weights, a number for every vertex, in the place of bones");
  PlacedCharacter placed = *primary.character;
  if (placed.clip < 0)
    return usage_error("\"" + primary.name + "\" plays no clip: there is no motion to follow", {},
                       "name one of its clips, or the file with its animation");
  if (primary.hybrid)
    return usage_error("\"" + primary.name + "\" yields to stand-ins, and its joints cannot follow as well so far", {},
                       "bake the hybrid pass first, and follow in a shot with its adjusted GLB");
  if (before && before->joints.empty())
    return usage_error("joints have to follow before vertices do", {},
                       "write it in front of [follow." + before->name + "]");
  if (before)
    if (Status s = apply_changes(placed.character, placed.clip, before->channels); !s) return s;
  const auto joints = joints_like(spec.bones, placed.character);
  if (!joints) return joints.error();
  FollowedBones followed = follow_bones(placed, primary.place, *joints, spec, timing, primary.scan.teleports);
  for (const int joint : *joints) group.joints.push_back(placed.character.nodes[at(joint)].name);
  if (before)
    for (const ChangedChannel& channel : before->channels)
      if (std::none_of(followed.channels.begin(), followed.channels.end(),
                       [&](const ChangedChannel& own) { return own.node == channel.node && own.path == channel.path; }))
        followed.channels.push_back(channel);
  if (Status s = apply_changes(placed.character, placed.clip, followed.channels); !s) return s;
  auto played = play(std::move(placed), primary.request);
  if (!played) return played.error();
  group.motion = std::make_shared<PlacedTrajectory>(std::move(played->trajectory), primary.place);
  group.channels = std::move(followed.channels);
  group.lag = std::move(followed.lag);
  group.turn = std::move(followed.turn);
  return {};
}

Status plan_vertices(const FollowSpec& spec, const PrimaryPlan& primary, const FollowTiming& timing,
                     const FollowGroup* before, FollowGroup& group) {
  auto weights =
      vertex_column(spec.weights, spec.column, primary.trajectory->surface().vertex_count(), 0, 1, "of a vertex");
  if (!weights) return weights.error();
  group.weighted = at(std::count_if(weights->begin(), weights->end(), [](double w) { return w > 0; }));
  if (group.weighted == 0) return usage_error("all weights are 0: nothing would follow", spec.weights.string());
  const auto motion = std::make_shared<FollowedPoints>(before ? before->motion : primary.trajectory,
                                                       std::move(*weights), spec, timing, primary.scan.teleports);
  for (int frame = 0; frame < timing.frame_count; ++frame) group.lag.push_back(motion->lag(frame / timing.fps));
  group.motion = motion;
  return {};
}

}  // namespace

Result<std::unique_ptr<FollowGroup>> plan_follow(const Shot& shot, const FollowSpec& spec, std::size_t p,
                                                 BakePlan& plan, const FollowGroup* before) {
  const PrimaryPlan& primary = plan.primaries[p];
  auto group = std::make_unique<FollowGroup>(p);
  group->name = spec.name;
  group->first_frame = shot.first_frame;
  group->preroll = shot.preroll;
  group->fps = shot.fps;
  const FollowTiming timing{shot.fps, shot.first_frame, shot.last_frame - shot.first_frame + 1, shot.preroll};
  const Status planned = spec.weights.empty() ? plan_joints(spec, primary, timing, before, *group)
                                              : plan_vertices(spec, primary, timing, before, *group);
  if (!planned) return located(planned.error(), shot, spec.owner());
  if (const double forgets = memory(spec); forgets > shot.preroll / shot.fps)
    plan.notes.push_back(fmt::format(
        "{}: its spring takes {} to forget how it began, and the pre-roll has {:.2g} s: in the first frames the lag "
        "hangs on where the bake begins (preroll under [shot] makes it longer)",
        spec.owner(), std::isfinite(forgets) ? fmt::format("{:.2g} s", forgets) : "forever", shot.preroll / shot.fps));
  SystemOutput output;
  output.primary = p;
  output.mesh = std::make_shared<const Mesh>(
      make_triangle_mesh(spec.name, bind_pose_of(*primary.trajectory), primary.trajectory->surface().triangles));
  group->outputs.push_back(std::move(output));
  return group;
}

Result<std::unique_ptr<Solver>> FollowGroup::make_solver() {
  return std::unique_ptr<Solver>(std::make_unique<FollowSolver>(*outputs.at(0).mesh, *this));
}

std::vector<std::string> FollowGroup::lines(const BakePlan& plan) const {
  const double most = lag.empty() ? 0 : *std::max_element(lag.begin(), lag.end());
  const double widest = turn.empty() ? 0 : *std::max_element(turn.begin(), turn.end());
  const std::string what = joints.empty() ? fmt::format("{} vertices", weighted)
                                          : fmt::format("{} joints ({})", joints.size(), joined(joints));
  return {fmt::format(
      "follow \"{}\" on \"{}\": {}, up to {:.3g} mm behind{}", name, plan.primaries[primary].name, what, 1e3 * most,
      joints.empty() ? "" : fmt::format(", turned by up to {:.3g} degrees", widest * 180 / std::numbers::pi))};
}

Result<std::vector<WrittenFile>> FollowGroup::files(const BakePlan& plan, std::vector<std::string>& notes) const {
  std::vector<WrittenFile> out;
  if (joints.empty()) return out;
  const PrimaryPlan& whose = plan.primaries[primary];
  const Playback& playback = whose.character->playback;
  auto made = export_motion(whose.request, *whose.character, channels,
                            {playback.start, playback.speed / fps, static_cast<int>(lag.size())});
  if (!made) return made.error();
  for (const std::string& note : made->notes) notes.push_back("follow \"" + name + "\": " + note);
  const auto text = std::as_bytes(std::span(made->bvh));
  out.push_back({name + "_follow.glb", std::move(made->glb)});
  out.push_back({name + "_follow.bvh", Bytes(text.begin(), text.end())});
  return out;
}

}  // namespace ft::inline baker
