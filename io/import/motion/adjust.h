// The motion of a character that yields: its root is displaced and turned as a hybrid pass says, limbs that are planted
// keep their ends in place, and what comes out are the changed channels of the clip, in the file's units, axes and
// parent spaces. Where nothing deviates, keys stay what they are to the bit.
#pragma once

#include <functional>
#include <vector>

#include "io/import/body/limbs.h"
#include "io/import/character/motion_change.h"
#include "io/import/motion/two_bone.h"

namespace ft::inline io {

/// How far the character is from its imported motion, in the world (metres, Y up).
struct RootDeviation {
  Vec3 displacement = Vec3::Zero();  ///< of the centre [m]
  Quat rotation = Quat::Identity();  ///< about the centre
  Vec3 centre = Vec3::Zero();        ///< in the imported motion, of mass [m]
};

/// Where the end of a limb is to be.
struct LimbTarget {
  Vec3 place = Vec3::Zero();  ///< of the end joint, in the world [m]
  double weight = 0;          ///< 0: as the body carries it; 1: at the place, turned as in the imported motion
};

struct AdjustedLimb {
  LimbChain chain;
  BendLimits limits;
  /// At a time of the clip [s], given where the imported motion has the end [m].
  std::function<LimbTarget(double time, const Vec3& imported)> target;
};

struct MotionAdjustment {
  std::vector<int> roots;                               ///< nodes that are moved; see motion_roots()
  std::function<RootDeviation(double time)> deviation;  ///< at a time of the clip [s]
  std::vector<AdjustedLimb> limbs;
  double first_frame = 0, frame_time = 1.0 / 24;  ///< the shot's frames in the clip's time: where keys are added [s]
  int frame_count = 1;                            ///< of the shot
};

struct AdjustedMotion {
  std::vector<ChangedChannel> channels;  ///< empty: nothing deviates
  double root_rest = 0;   ///< most that the root moved further because a limb could not reach its place [m]
  double worst_miss = 0;  ///< most that an end is away from its place at a key: two places too far apart [m]
};

/// The node to be moved for a clip: of the pelvis and what is above it the topmost that the clip moves, so that its own
/// parent stands still; several where the file has several roots that carry the chosen meshes (all where none are
/// chosen).
std::vector<int> motion_roots(const Character& character, int clip, const std::vector<int>& meshes);

/// placement takes file units and axes to metres and Y-up. Keys lie at the times at which the file has some, and at
/// frames of the shot between those where straight lines between keys would be off by more than 2e-7 (m, rad). Steps
/// stay steps; splines become straight lines between frames, in channels that change. Errors: a clip or node that does
/// not exist, a limb that is not below a root, a turn below a node that is scaled unequally, what is not finite.
Result<AdjustedMotion> adjust_motion(const Character& character, int clip, const Mat4& placement,
                                     const MotionAdjustment& adjustment);

}  // namespace ft::inline io
