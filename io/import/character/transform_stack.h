// A node's transform as the file builds it: elementary transforms in order (translate, rotate, scale, matrix), whose
// numbers may be moved by curves in several layers. Evaluated as it is at any time, so rotations go the way that their
// angles go. Also: how a scale is passed on to the nodes below (segment scale compensation), and shapes in between.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "baker/core/types.h"
#include "io/import/character/curve.h"

namespace ft::inline io {

/// What an animation layer does to the value that the layers before it have made.
enum class LayerMode : std::uint8_t {
  k_additive,  ///< adds its value times its weight
  k_override,  ///< replaces it
  k_blend,     ///< replaces it by the part that its weight is ("override passthrough")
};

struct AnimationLayer {
  LayerMode mode = LayerMode::k_override;
  double weight = 1;                ///< 0..1
  std::int32_t weight_curve = -1;   ///< of percent, into the clip's curves; -1: `weight` holds
  bool composes_rotations = false;  ///< as rotations; else their angles one by one
  bool multiplies_scales = false;   ///< else they are added
};

/// What one layer says of three numbers.
struct LayeredNumbers {
  std::int32_t layer = 0;     ///< into the clip's layers
  Vec3 fixed = Vec3::Zero();  ///< where there is no curve
  std::array<std::int32_t, 3> curves{-1, -1, -1};
};

struct AnimatedNumbers {
  Vec3 rest = Vec3::Zero();
  std::vector<LayeredNumbers> layers;  ///< in the order of the clip's
};

enum class TransformKind : std::uint8_t { k_translate, k_rotate, k_rotate_about, k_scale, k_matrix };

/// Which axis turns first: k_xyz turns about x, then about the parent's y, then about its z.
enum class RotationOrder : std::uint8_t { k_xyz, k_xzy, k_yzx, k_yxz, k_zxy, k_zyx };

struct ElementaryTransform {
  TransformKind kind = TransformKind::k_translate;
  RotationOrder order = RotationOrder::k_xyz;  ///< of k_rotate
  bool inverted = false;                       ///< of k_translate and k_rotate
  double unit = 1;                             ///< of k_translate: file units of the character in one of the numbers'
  AnimatedNumbers numbers;                     ///< file units, degrees (k_rotate_about: the first), factors
  Vec3 axis = Vec3::UnitX();                   ///< of k_rotate_about, any length above 0
  Mat4 matrix = Mat4::Identity();              ///< of k_matrix
};

/// How a node takes the scale of its parent.
enum class ScaleInheritance : std::uint8_t {
  k_product,        ///< the parent's matrix holds for it, with shear where it is turned (FBX "RSrs")
  k_componentwise,  ///< along its own axes, without shear (FBX "RrSs")
  k_compensated,    ///< not that of its parent, but what that one takes itself (FBX "Rrs", Maya's joints)
};

/// All of one node's transform.
struct TransformStack {
  std::int32_t node = -1;
  ScaleInheritance inheritance = ScaleInheritance::k_product;
  std::vector<ElementaryTransform> elements;  ///< outermost first: matrix = product in this order
};

/// A shape and those in between, moved by one number.
struct ShapeChannel {
  struct Shape {
    std::int32_t morph = 0;  ///< of the node
    double full = 100;       ///< percent at which it stands alone
  };
  std::int32_t node = -1;
  std::vector<Shape> shapes;  ///< by `full`, ascending
  AnimatedNumbers percent;    ///< the first number
};

/// What the stacks and shapes of one clip refer to.
struct ClipCurves {
  std::vector<Curve> curves;
  std::vector<AnimationLayer> layers;
};

/// matrix = translation * turn * scale for stacks whose scales come after their rotations.
struct StackPose {
  Mat4 matrix = Mat4::Identity();
  Mat3 turn = Mat3::Identity();
  Vec3 scale = Vec3::Ones();
};

/// Adds the curves that move it.
void add_curves(const AnimatedNumbers& numbers, std::vector<std::int32_t>& to);
void add_curves(const TransformStack& stack, std::vector<std::int32_t>& to);

Quat rotation_of(const Vec3& degrees, RotationOrder order);
/// The angles [degrees] that give a rotation; the second one to turn is within -90..90.
Vec3 angles_of(const Quat& rotation, RotationOrder order);

/// Three numbers at a time [s]; kind says how layers put rotations and scales together.
Vec3 numbers_at(const AnimatedNumbers& numbers, TransformKind kind, RotationOrder order, const ClipCurves& set,
                double time);
StackPose stack_pose(const TransformStack& stack, const ClipCurves& set, double time);

/// Weights of the shapes at a percentage: straight between neighbours, 0 % counts as a shape of no change, beyond the
/// outermost one it grows on.
void shape_weights(std::span<const ShapeChannel::Shape> shapes, double percent, std::span<double> out);

/// Turns poses of stacks into matrices relative to the parent whose plain products are the nodes' places, for nodes
/// that are given in their order, parents first. A node that was not given passes on the scale that `set_scale` says.
class ScalePassing {
 public:
  explicit ScalePassing(std::size_t node_count);
  /// Matrix relative to the parent (-1: none) of a node with that pose.
  Mat4 local(int node, int parent, ScaleInheritance inheritance, const StackPose& pose);
  void set_scale(int node, const Vec3& scale);

 private:
  std::vector<Vec3> scale_;  ///< that a node passes on
  std::vector<int> source_;  ///< the node whose scale it takes itself; -1: none
};

}  // namespace ft::inline io
