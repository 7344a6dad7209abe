// Character: what a file holds, in neutral words, as it crosses from the importing child process to us. Units and axes
// are the file's own; `file_unit` and `file_axes` say how they become metres and Y-up. Nothing in it is trusted before
// check_character() has passed it: numbers finite, indices in range, parents before children, times ascending.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "baker/core/bytes.h"
#include "baker/core/hash.h"
#include "baker/core/result.h"
#include "baker/core/types.h"
#include "io/import/character/character_content.h"
#include "io/import/character/transform_stack.h"

namespace ft::inline io {

enum class KeyInterpolation : std::uint8_t { k_step, k_linear, k_cubic };

/// Keys of one animated quantity. Cubic keys hold (in-tangent, value, out-tangent) per key, as glTF does.
struct Track {
  KeyInterpolation interpolation = KeyInterpolation::k_linear;
  int width = 0;               ///< numbers per value: 3 vectors, 4 quaternions (x y z w), n morph weights
  std::vector<double> times;   ///< s, strictly ascending
  std::vector<double> values;  ///< times * width (* 3 when cubic)
  bool empty() const { return times.empty(); }
  std::size_t stride() const {
    return static_cast<std::size_t>(width) * (interpolation == KeyInterpolation::k_cubic ? 3 : 1);
  }
};

/// What one clip does to one node; an empty track leaves the node's rest value.
struct Channel {
  int node = -1;
  Track translation, rotation, scale, weights;
};

/// A node is moved by its stack, if it has one; a channel of the same node replaces the parts that it has keys for.
struct Clip {
  std::string name;
  double start = 0, end = 0;  ///< s: what the file says that it lasts, else first and last key
  std::vector<Channel> channels = {};
  std::vector<TransformStack> stacks = {};  ///< at most one per node
  std::vector<ShapeChannel> shapes = {};
  ClipCurves curves = {};      ///< of the stacks and shapes
  bool has_own_range = false;  ///< the file says how long it lasts; a pose that is held is part of it
  double duration() const { return end - start; }
  /// Nodes and shapes that it moves.
  int moved_count() const { return static_cast<int>(channels.size() + stacks.size() + shapes.size()); }
  /// Sets start and end from the keys, 0 and 0 without any, unless the file says them.
  void find_range();
};

struct CharacterNode {
  std::string name;
  int parent = -1;                    ///< below its own index; -1 for a root
  Mat4 local = Mat4::Identity();      ///< rest transform, relative to the parent
  std::vector<double> morph_weights;  ///< rest weights of the morphs of its meshes
};

struct SkinBone {
  int node = -1;
  Mat4 inverse_bind = Mat4::Identity();  ///< mesh space to bone space in the bind pose
};

struct MorphTarget {
  std::string name;
  std::vector<Vec3> deltas;  ///< one per vertex
};

struct CharacterMesh {
  std::string name;
  int node = -1;
  bool visible = true;  ///< as the file says; what is not joins the collider only where it is asked for by name
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<SkinBone> bones;           ///< empty: rigid, follows `node`
  std::vector<int> influence_start;      ///< vertex count + 1 rows; empty when bones is
  std::vector<int> influence_bone;       ///< into bones
  std::vector<double> influence_weight;  ///< a row sums to 1, or is empty: the vertex follows `node`
  /// Per vertex: the share of it that is skinned by dual quaternions instead of linearly, 0..1; empty: none.
  std::vector<double> dual_share = {};
  std::vector<MorphTarget> morphs;
};

/// Another file that the import read (a .bin, a .mtl): part of the content, and of staleness.
struct Dependency {
  std::string path;  ///< relative to the folder of the character's file
  Hash128 hash;
};

struct Character {
  std::string format;                 ///< "glTF", "FBX", ...
  double file_unit = 1;               ///< m per file unit, as the file says; 0 when the format carries none (BVH)
  Mat3 file_axes = Mat3::Identity();  ///< rotation from file axes to Y-up, as the file says
  std::string file_up = "y";          ///< "y", "z", "x"; "" when the format carries none
  std::vector<CharacterNode> nodes;
  std::vector<CharacterMesh> meshes;  ///< one per use of a mesh by a node
  std::vector<Clip> clips;
  std::vector<Dependency> dependencies;
  std::vector<CharacterContent> contents;  ///< in the order in which a reader of `info FILE` wants to see them
  std::vector<std::string> notes;
};

/// Caps on what an import may return.
inline constexpr std::size_t k_max_character_nodes = 200'000;
inline constexpr std::size_t k_max_character_vertices = 20'000'000;
inline constexpr std::size_t k_max_character_keys = 200'000'000;

/// Every index, size and number; the first fault found, in words.
Status check_character(const Character& character);

Bytes save_character(const Character& character);
/// Refuses anything cut, longer than said, of another version, or that check_character() refuses.
Result<Character> load_character_bytes(std::span<const std::byte> data);

}  // namespace ft::inline io
