// A skeleton as the stand that a body is built on: in a frame where Y is up and it is 1 tall, its limbs apart.
#pragma once

#include <span>
#include <vector>

#include "io/import/body/figure.h"

namespace ft::inline io {

/// Joints in the normal frame: position = scale * axes * global translation. The pose is the one that was asked for,
/// with arms that hang beside the body raised to the side, so that hands do not grow together with thighs.
struct BodyFrame {
  std::vector<Mat4> globals;  ///< of all nodes in that pose, file units and axes
  bool arms_raised = false, legs_parted = false;
  std::vector<Vec3> joints;
  std::vector<char> members;               ///< of the skeleton: below its root, and of the figure (figure_nodes())
  std::vector<std::vector<int>> children;  ///< of members
  Figure figure;
  Mat3 axes = Mat3::Identity();
  double scale = 1;  ///< 1 / (height in file units)
};

/// Of the skeleton below `root`, in the pose of these globals. Fails when it has no height.
Result<BodyFrame> body_frame(const Character& character, int root, const Mat3& axes, std::span<const Mat4> globals);

/// Where the two sides of a body meet: hip joints, shoulder joints, and the directions they give.
struct Landmarks {
  int hips = 0, neck = -1, chest = 0;
  std::vector<int> thighs, arms;
  std::vector<int> spine;  ///< joints from the hips up to the chest
  Vec3 side = Vec3::UnitX(), forward = Vec3::UnitZ();
  bool complete = false;  ///< two thighs and two arms
};

Landmarks find_landmarks(const Character& character, const BodyFrame& frame, const std::vector<Limb>& limb);

}  // namespace ft::inline io
