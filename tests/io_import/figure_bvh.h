// A figure of 1.77 m that walks in place, as a BVH in any of the ways in which motion capture comes: names of joints,
// rest pose, unit, up axis. All of them are the same motion.
#pragma once

#include <array>
#include <string>

#include "baker/core/types.h"

namespace ft::test {

inline constexpr int k_figure_joints = 21;

/// Hips, spine, chest, neck, head; left collar, upper arm, forearm, hand; the right ones; left thigh, shin, foot, toes;
/// the right ones.
using FigureNames = std::array<const char*, k_figure_joints>;

enum class FigureRest {
  k_t_pose,
  k_a_pose,  ///< arms 45 degrees down
  k_arms_down,
  k_bones_on_x,  ///< every bone along x, as Rokoko's and LaFAN1's
  k_mirrored_x,  ///< left limbs along x, right ones along -x
};

struct FigureKind {
  FigureNames names;
  FigureRest rest = FigureRest::k_t_pose;
  double units_per_metre = 100;
  bool z_up = false;
  const char* root = nullptr;  ///< a joint on the floor above the hips
  double hips = 0.09;          ///< of a hip joint from the middle [m]
};

std::string figure_bvh(const FigureKind& kind, int frames = 12);

/// Where the joints are in a T-pose that stands at the origin, facing z [m, Y-up].
std::array<Vec3, k_figure_joints> figure_t_pose(double hips = 0.09);

}  // namespace ft::test
