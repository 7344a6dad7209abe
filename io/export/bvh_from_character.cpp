// A new BVH. Its joints have no rest rotation, so that a joint's rotation is all of its turn against its parent, and
// its offset is where it is in its parent's frame. Scales above are in the offsets, which are measured in the world.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "io/export/bvh_export.h"
#include "io/import/body/bind.h"
#include "io/import/character/pose.h"

namespace ft::inline io {
namespace {

constexpr std::array<int, 3> k_order{2, 0, 1};  // Z, X, Y
constexpr double k_same_offset = 1e-6;          // m

constexpr std::size_t k_most_joints = 4096;

struct Joint {
  int node = -1, parent = -1;  ///< parent: into the joints
  std::string name;
  bool moves = false;                    ///< has position channels
  std::vector<Vec3> offsets, positions;  ///< in the parent's frame and in the world, per frame [m]
  std::vector<Quat> rotations, turns;    ///< in the world and against the parent, per frame
};

/// Nodes that bear a skin or move and all between them, parents first; none where no node is above them all.
std::vector<Joint> find_joints(const Character& character, int clip) {
  const std::size_t count = character.nodes.size();
  std::vector<char> wanted(count, 0);
  for (const CharacterMesh& mesh : character.meshes)
    for (const SkinBone& bone : mesh.bones) wanted[at(bone.node)] = 1;
  if (clip >= 0) {
    for (const Channel& channel : character.clips[at(clip)].channels) wanted[at(channel.node)] = 1;
    for (const TransformStack& stack : character.clips[at(clip)].stacks) wanted[at(stack.node)] = 1;
  }
  if (std::none_of(wanted.begin(), wanted.end(), [](char w) { return w != 0; })) wanted.assign(count, 1);
  std::vector<int> below(count, 0);  // wanted nodes in the branch
  int all = 0;
  for (std::size_t i = count; i-- > 0;) {
    below[i] += wanted[i], all += wanted[i];
    if (character.nodes[i].parent >= 0) below[at(character.nodes[i].parent)] += below[i];
  }
  std::vector<Joint> joints;
  std::vector<int> joint_of(count, -1);
  std::set<std::string> names;
  int root = -1;
  for (std::size_t i = 0; i < count; ++i)
    if (below[i] == all) root = static_cast<int>(i);
  if (root < 0) return joints;
  for (std::size_t i = at(root); i < count; ++i) {
    const int parent = character.nodes[i].parent;
    const bool first = static_cast<int>(i) == root;
    if (below[i] == 0 || (!first && (parent < 0 || joint_of[at(parent)] < 0))) continue;
    Joint joint;
    joint.node = static_cast<int>(i);
    joint.parent = first ? -1 : joint_of[at(parent)];
    joint.name = character.nodes[i].name.empty() ? "joint" : character.nodes[i].name;
    for (char& c : joint.name)
      if (static_cast<unsigned char>(c) <= ' ' || c == '{' || c == '}') c = '_';
    for (int n = 2; !names.insert(joint.name).second; ++n) joint.name += fmt::format("_{}", n);
    joint_of[i] = static_cast<int>(joints.size());
    joints.push_back(std::move(joint));
  }
  return joints;
}

void sample(const Character& character, int clip, const Mat4& placement, const BvhFrames& frames,
            std::vector<Joint>& joints) {
  const ClipPose pose(character, clip < 0 ? nullptr : &character.clips[at(clip)]);
  std::vector<Mat4> locals(character.nodes.size()), globals(character.nodes.size());
  std::vector<double> morphs(pose.rest_morphs().size());
  for (int f = 0; f < frames.count; ++f) {
    pose.sample(frames.start + f * frames.time, locals, morphs);
    globals_from_locals(character.nodes, locals, globals);
    for (Joint& joint : joints) {
      const NodeTransform world = decompose(placement * globals[at(joint.node)]);
      joint.positions.push_back(world.translation);
      joint.rotations.push_back(world.rotation);
      joint.offsets.push_back(world.translation);
      joint.turns.push_back(world.rotation);
      if (joint.parent < 0) continue;
      const Joint& parent = joints[at(joint.parent)];
      const Quat back = parent.rotations.back().conjugate();
      joint.offsets.back() = back * (world.translation - parent.positions.back());
      joint.turns.back() = back * world.rotation;
    }
  }
  for (Joint& joint : joints)
    joint.moves = joint.parent < 0 || std::any_of(joint.offsets.begin(), joint.offsets.end(), [&](const Vec3& o) {
                    return (o - joint.offsets.front()).norm() > k_same_offset;
                  });
}

/// Channels of the joints in the order in which the hierarchy lists them.
void write_joint(const std::vector<Joint>& joints, std::size_t index, int depth, std::string& out,
                 std::vector<std::size_t>& order) {
  const Joint& joint = joints[index];
  const std::string indent(at(depth), '\t');
  const Vec3 offset = joint.parent < 0 ? Vec3::Zero().eval() : joint.offsets.front();
  order.push_back(index);
  out += fmt::format("{0}{1} {2}\n{0}{{\n{0}\tOFFSET {3:.6f} {4:.6f} {5:.6f}\n", indent,
                     joint.parent < 0 ? "ROOT" : "JOINT", joint.name, offset.x(), offset.y(), offset.z());
  out += fmt::format("{}\tCHANNELS {}Zrotation Xrotation Yrotation\n", indent,
                     joint.moves ? "6 Xposition Yposition Zposition " : "3 ");
  bool leaf = true;
  for (std::size_t child = index + 1; child < joints.size(); ++child)
    if (joints[child].parent == static_cast<int>(index))
      write_joint(joints, child, depth + 1, out, order), leaf = false;
  if (leaf)  // half as long as the bone that leads to it: nothing says how long it is
    out += fmt::format("{0}\tEnd Site\n{0}\t{{\n{0}\t\tOFFSET 0.000000 {1:.6f} 0.000000\n{0}\t}}\n", indent,
                       0.5 * offset.norm());
  out += fmt::format("{}}}\n", indent);
}

}  // namespace

Result<std::string> bvh_from_character(const Character& character, int clip, const Mat4& placement,
                                       const BvhFrames& frames) {
  if (clip >= static_cast<int>(character.clips.size())) return usage_error(fmt::format("clip {} does not exist", clip));
  if (!(frames.time > 0) || !std::isfinite(frames.time) || !std::isfinite(frames.start) || frames.count < 1)
    return usage_error("the frames of a BVH have to follow each other");
  if (character.nodes.empty()) return input_error("has no skeleton");
  std::vector<Joint> joints = find_joints(character, clip);
  if (joints.empty())
    return input_error("has several skeletons, and a BVH made of them could hold one only", "",
                       "keep one skeleton in the file, or put a node above them");
  if (joints.size() > k_most_joints) return input_error("has more joints than a BVH is made of: 4096");
  sample(character, clip, placement, frames, joints);
  std::string out = "HIERARCHY\n";
  std::vector<std::size_t> order;
  write_joint(joints, 0, 0, out, order);
  out += fmt::format("MOTION\nFrames: {}\nFrame Time: {:.9g}\n", frames.count, frames.time);
  std::vector<Vec3> angles(joints.size(), Vec3::Zero());
  for (std::size_t f = 0; f < at(frames.count); ++f) {
    for (std::size_t k = 0; k < order.size(); ++k) {
      const Joint& joint = joints[order[k]];
      const Vec3& p = joint.offsets[f];
      Vec3& angle = angles[order[k]];
      if (!p.allFinite()) return input_error("is not finite", fmt::format("node \"{}\"", joint.name));
      angle = euler_angles(joint.turns[f], k_order, angle);
      const Vec3 degrees = angle * (180 / std::numbers::pi);
      if (joint.moves) out += fmt::format("{:.6f} {:.6f} {:.6f} ", p.x(), p.y(), p.z());
      out +=
          fmt::format("{:.6f} {:.6f} {:.6f}{}", degrees[0], degrees[1], degrees[2], k + 1 < order.size() ? " " : "\n");
    }
  }
  return out;
}

}  // namespace ft::inline io
