// One moment of an adjusted motion: all moved nodes of a character, from the pose of the clip, the deviation of the
// root and the places of planted limbs. Used by adjust_motion() at every key.
#pragma once

#include "io/import/character/pose.h"
#include "io/import/motion/adjust.h"

namespace ft::inline io {

/// A moved node at one time, relative to its parent.
struct AdjustedNode {
  NodeTransform source, now;
  double scale = 1;  ///< m per unit of the parent's space
};

struct AdjustedPose {
  std::vector<AdjustedNode> nodes;  ///< in the order of PoseAdjuster::nodes()
  double root_rest = 0, miss = 0;   ///< see AdjustedMotion [m]
};

class PoseAdjuster {
 public:
  /// The references have to outlive it; what they name has been checked.
  PoseAdjuster(const Character& character, const Clip& clip, const Mat4& placement, const MotionAdjustment& adjustment);

  /// Roots, then upper, lower and end of each limb.
  const std::vector<int>& nodes() const { return nodes_; }
  Result<AdjustedPose> solve(double time) const;

 private:
  struct Planted {
    bool active = false;
    LimbTarget target;
    Quat imported_rotation;
  };
  void globals(const std::vector<Mat4>& locals, std::vector<Mat4>& out) const;
  Status move_roots(const Eigen::Isometry3d& deviation, bool turns, std::span<const Mat4> globals,
                    AdjustedPose& pose) const;
  void bend_limb(std::size_t limb, const Planted& planted, const Vec3& target, std::span<const Mat4> globals,
                 AdjustedPose& pose) const;
  TwoBonePose places(const LimbChain& chain, std::span<const Mat4> globals) const;
  void find_axes();

  const Character& character_;
  const Clip& clip_;
  Mat4 placement_;
  const MotionAdjustment& adjustment_;
  ClipPose pose_;
  std::vector<int> nodes_;
  std::vector<const Channel*> channels_;  ///< of nodes_; null: it rests
  std::vector<char> stacked_;             ///< of nodes_: a stack of transforms moves it
  std::vector<NodeTransform> rest_;       ///< of nodes_
  std::vector<Vec3> axes_;                ///< about which a limb usually bends, in the frame of its upper bone
};

}  // namespace ft::inline io
