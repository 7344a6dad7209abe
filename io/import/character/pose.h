// Where the nodes of a character are at a time of a clip. Own evaluator, in double: keys are searched by time, held
// outside their range, steps stay steps, rotations go the short way round, cubic keys follow the glTF 2.0 specification
// (appendix C). Stacks of transforms are evaluated as they are (transform_stack.h); a node's matrix relative to its
// parent is always one whose product with the parent's is its place, whatever scale it inherits.
#pragma once

#include <span>
#include <vector>

#include "io/import/character/character.h"

namespace ft::inline io {

/// Translation, proper rotation and what remains (scale, shear, reflection): matrix = T * R * K.
struct NodeTransform {
  Vec3 translation = Vec3::Zero();
  Quat rotation = Quat::Identity();
  Mat3 stretch = Mat3::Identity();
  Mat4 matrix() const;
};

/// By polar decomposition (proper rotation); a singular matrix keeps an identity rotation and everything in the
/// stretch.
NodeTransform decompose(const Mat4& matrix);
/// Translations and stretches linearly, rotations by slerp; exactly a at 0 and b at 1.
NodeTransform blend(const NodeTransform& a, const NodeTransform& b, double weight);

/// Value of a track at a time [s] into out (width numbers). Rotations come out with unit length.
void sample_track(const Track& track, double time, bool rotation, std::span<double> out);

/// A node's transform at a time: rest, with what the channel's tracks have put over it.
NodeTransform sample_channel(const Channel& channel, const NodeTransform& rest, double time);

/// All that moves in one clip, ready to be sampled at any time; thread-safe.
class ClipPose {
 public:
  /// clip may be null: the rest pose.
  ClipPose(const Character& character, const Clip* clip);
  /// Local matrices of all nodes and the morph weights of all nodes in turn (see morph_start).
  void sample(double time, std::span<Mat4> locals, std::span<double> morphs) const;
  std::span<const Mat4> rest() const { return rest_; }
  std::span<const double> rest_morphs() const { return rest_morphs_; }
  /// Where the weights of a node begin; node count + 1 entries.
  std::span<const int> morph_start() const { return morph_start_; }
  int node_count() const { return static_cast<int>(rest_.size()); }

 private:
  struct Moving {
    Channel channel;
    NodeTransform rest;
    bool over_stack = false;  // its rest is then what the stack says at the time
  };
  void sample_stacks(double time, std::span<Mat4> locals) const;

  std::vector<int> parents_;
  std::vector<TransformStack> stacks_;  // parents first
  std::vector<ShapeChannel> shapes_;
  ClipCurves curves_;
  std::vector<Mat4> rest_;
  std::vector<double> rest_morphs_;
  std::vector<int> morph_start_;
  std::vector<Moving> moving_;
};

/// Local to global, in node order (parents first).
void globals_from_locals(std::span<const CharacterNode> nodes, std::span<const Mat4> locals, std::span<Mat4> globals);

/// The rest places of nodes in the scene, file units and axes.
std::vector<Mat4> rest_globals(std::span<const CharacterNode> nodes);

}  // namespace ft::inline io
