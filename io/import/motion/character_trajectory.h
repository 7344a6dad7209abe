// A character playing a clip, as a Trajectory: pose of the nodes at the shot's time, pre-roll blend from the bind pose,
// run-up, skin.
#pragma once

#include <memory>
#include <optional>

#include "baker/core/trajectory.h"
#include "io/import/body/bind.h"
#include "io/import/body/skin.h"
#include "io/import/character/pose.h"

namespace ft::inline io {

struct Playback {
  double start = 0;  ///< time in the file at the shot's first frame [s]
  double speed = 1;
  double preroll = 1;  ///< s
  /// Of a geometry cache: time in the file of the pose that garments are modelled on [s]; none: that at `start`.
  std::optional<double> bind;
  bool loop = false;  ///< of a geometry cache: its samples repeat; a clip that repeats has the keys for it (cycle.h)
};

class CharacterTrajectory : public Trajectory {
 public:
  /// placement takes file units and axes to metres and Y-up: unit * rotation. clip may be null: the rest pose stands
  /// still.
  CharacterTrajectory(std::shared_ptr<const Character> character, const Clip* clip, Skin skin, BindPose bind,
                      int pelvis, const Mat4& placement, const Playback& playback);

  const Surface& surface() const override { return skin_.surface; }
  void bind_pose(std::span<Vec3> positions) const override;
  void sample(double time, std::span<Vec3> positions) const override;
  Eigen::Isometry3d bind_to_start() const override;
  double preroll() const override { return playback_.preroll; }

  const Skin& skin() const { return skin_; }

 private:
  void globals_at(double time, std::vector<Mat4>& globals, std::vector<double>& morphs) const;

  std::shared_ptr<const Character> character_;
  Skin skin_;
  BindPose bind_;
  ClipPose pose_;
  Mat4 placement_;
  Playback playback_;
  Eigen::Isometry3d bind_to_start_ = Eigen::Isometry3d::Identity();
  // Both ends of the pre-roll. Nodes below the pelvis blend in their parent's space, the pelvis and all others in the
  // world: turning a far-away root would swing the character through the set.
  struct Blend {
    bool in_parent = false;
    NodeTransform from, to;
  };
  std::vector<Blend> blends_;
  std::vector<double> start_morphs_;
  Vec3 start_velocity_ = Vec3::Zero();  ///< of the pelvis at the first frame, in the world [m/s]
};

/// Heading: the turn about Y that is in a rotation; 0 when it is upside down.
double heading(const Mat3& rotation);

}  // namespace ft::inline io
