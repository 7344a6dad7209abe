// What a joint is, and of which side, by its name: the one place that knows how programs and libraries name the joints
// of a figure. Known are CMU and Biovision (LeftUpLeg, LeftHip, lhumerus), Mixamo (mixamorig:LeftUpLeg), Rokoko and
// LaFAN1 (LeftLeg), Bandai Namco (UpperLeg_L), 3ds Max bipeds and Truebones (Bip01 L Thigh), Unreal (thigh_l), Rigify
// (upper_arm.L), VRM (J_Bip_L_UpperLeg), SMPL (L_Hip), Poser (lShldr), Motive (LUArm), Xsens (T8).
#pragma once

#include <string>
#include <string_view>

namespace ft::inline io {

enum class Limb {
  k_hips,
  k_torso,
  k_neck,
  k_head,
  k_hip_joint,
  k_thigh,
  k_shin,
  k_foot,
  k_toe,
  k_collar,
  k_upper_arm,
  k_forearm,
  k_hand,
  k_finger,
  k_other
};

enum class Side { k_none, k_left, k_right };

/// Namespaces ("mixamorig:"), separators, digits and case do not matter.
Limb limb_by_name(std::string_view name);
Side side_by_name(std::string_view name);

}  // namespace ft::inline io
