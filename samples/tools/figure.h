// A jointed figure of a child or an adult, whose motion is written as a BVH: a body is built around it on import. Legs
// turn about x alone and the trunk about x and y, so that a pose is a table of angles; the arms reach for a place. For
// make_set.
#pragma once

#include <array>
#include <numbers>
#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft::sets {

constexpr double k_rad = std::numbers::pi / 180;

/// Arms: collar, upper arm, forearm, hand of the left side, then of the right. Legs: thigh, shin, foot, toes.
enum JointIndex {
  k_hips,
  k_spine,
  k_waist,
  k_chest,
  k_neck,
  k_head,
  k_arms,
  k_legs = k_arms + 8,
  k_joints = k_legs + 8
};

struct Pose {
  Vec3 hips = Vec3::Zero();                              ///< m
  double lean = 0, tilt = 0;                             ///< rad, backwards: the chest's lean against the pelvis' tilt
  std::array<double, 2> thigh{}, shin{}, foot{};         ///< rad, forwards and up, in the world; 0 as it stands
  std::array<Vec3, 2> grip{Vec3::Zero(), Vec3::Zero()};  ///< m, where the middle of each hand is
  std::array<double, 2> toes{};                          ///< rad, up, against the foot
  double pelvis_turn = 0, chest_turn = 0;                ///< rad, about the vertical, to the left
  Vec3 elbows{2, -1, -0.5};                              ///< where the left elbow points to, in the chest's frame
};

class Figure {
 public:
  /// height [m]: from the soles to the crown, a hand's breadth more or less.
  explicit Figure(double height);

  double size() const { return size_; }  ///< against the child of 1.2 m, by whose lengths poses are thought of
  double standing() const;               ///< m, of the hips
  double thigh() const;                  ///< m, lengths
  double shin() const;
  double ankle() const;                                    ///< m, above the ground
  double hip_drop() const;                                 ///< m, from the hips to the hip joints
  Vec3 hip_joint(const Pose& pose, int side) const;        ///< m, 0 the left one
  Vec3 ball() const;                                       ///< m, of a foot, from its ankle as it stands
  double hip_above_seat() const { return 0.078 * size_; }  ///< m, of the hip joints over what it sits on

  std::string bvh(const std::vector<Pose>& poses, double fps) const;

 private:
  struct Joint {
    const char* name;
    int parent;
    Vec3 offset;  ///< m from the parent, arms out to the sides
    Vec3 end;     ///< m, of an end site; zero where joints follow
  };
  using Turns = std::array<Mat3, k_joints>;  ///< of the joints, in the world

  static std::vector<Joint> skeleton();
  static Turns turns_of_trunk(const Pose& pose);
  Turns turns(const Pose& pose) const;
  void reach(const Pose& pose, int side, Turns& turns) const;
  void write_joint(std::string& out, int& at_joint, int depth) const;
  void write_pose(std::string& out, const Pose& pose) const;

  double size_;
  std::vector<Joint> joints_;
};

/// 0 up to `from`, 1 from `to` on.
double smooth(double from, double to, double t);
Mat3 pitch(double angle);
Mat3 yaw(double angle);

}  // namespace ft::sets
