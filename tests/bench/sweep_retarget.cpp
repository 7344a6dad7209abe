#include "tests/bench/sweep_retarget.h"

#include <Eigen/LU>
#include <algorithm>
#include <span>

#include "baker/core/file.h"
#include "io/export/glb_from_character.h"
#include "io/import/body/bind.h"
#include "io/import/character/pose.h"
#include "io/import/motion/placement.h"

namespace ft::bench {
namespace {

/// `above`: the joint that it hangs on; `along`: the one that its bone points to, -1 for what is not brought into line.
struct JointRow {
  int above, along;
  std::vector<const char*> names;  ///< in small letters, the surest first
};

enum : int { k_hips, k_spine, k_chest, k_neck, k_head, k_left = 5, k_right = 13 };
/// Behind k_left and k_right.
constexpr int k_shoulder = 0, k_upper_arm = 1, k_forearm = 2, k_hand = 3, k_thigh = 4, k_shin = 5, k_foot = 6;

/// The trunk, then the left side; the right one has the same with other names.
const std::vector<JointRow>& joint_rows() {
  static const std::vector<JointRow> rows = {
      {-1, -1, {"def-hips", "hips", "pelvis"}},
      {k_hips, -1, {"def-spine.001", "spine_01", "lowerback", "spine"}},
      {k_spine, -1, {"def-spine.003", "spine_03", "chest2", "spine3", "chest", "spine1"}},
      {k_chest, -1, {"def-neck", "neck_01", "lowerneck", "neck"}},
      {k_neck, -1, {"def-head", "head"}},
      {k_chest, -1, {"def-shoulder.l", "clavicle_l", "leftcollar", "leftshoulder"}},
      {k_chest, k_left + k_forearm, {"def-upper_arm.l", "upperarm_l", "upperarm.l", "leftarm", "leftshoulder"}},
      {k_left + k_upper_arm,
       k_left + k_hand,
       {"def-forearm.l", "lowerarm_l", "lowerarm.l", "leftforearm", "leftelbow"}},
      {k_left + k_forearm, -1, {"def-hand.l", "hand_l", "hand.l", "lefthand", "leftwrist"}},
      {k_hips, k_left + k_shin, {"def-thigh.l", "thigh_l", "upperleg.l", "leftupleg", "lefthip"}},
      {k_left + k_thigh, k_left + k_foot, {"def-shin.l", "calf_l", "lowerleg.l", "leftleg", "leftknee"}},
      {k_left + k_shin, -1, {"def-foot.l", "foot_l", "foot.l", "leftfoot", "leftankle"}},
      {k_left + k_foot, -1, {"def-toe.l", "ball_l", "toes.l", "lefttoebase", "lefttoe"}},
  };
  return rows;
}

std::string on_the_right(std::string name) {
  if (name.starts_with("left")) return "right" + name.substr(4);
  if (name.ends_with(".l") || name.ends_with("_l")) name.back() = 'r';
  return name;
}

int to_the_right(int joint) {
  return joint >= k_left ? joint + k_right - k_left : joint;
}

std::string plain_name(const std::string& name) {
  std::string out = name.substr(name.find_last_of(":|") + 1);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool is_below(const Character& character, int node, int above) {
  while (node >= 0 && node != above) node = character.nodes[at(node)].parent;
  return node >= 0;
}

struct Row {
  int above = -1, along = -1;
};
std::array<Row, k_common_joints> rows_of_joints() {
  std::array<Row, k_common_joints> out;
  const auto& rows = joint_rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out[i] = {rows[i].above, rows[i].along};
    if (i >= at(k_left)) out[i + at(k_right - k_left)] = {to_the_right(rows[i].above), to_the_right(rows[i].along)};
  }
  return out;
}

/// Bind pose in metres and Y up.
struct Placed {
  Mat4 matrix = Mat4::Identity();
  std::vector<Mat4> bind;
  CommonJoints joints;

  Vec3 place(int joint) const { return bind[at(joints.node[at(joint)])].topRightCorner<3, 1>(); }
  bool has(int joint) const { return joint >= 0 && joints.node[at(joint)] >= 0; }
};

Result<Placed> place(const Character& character) {
  Placed out;
  out.bind = find_bind_pose(character).globals;
  std::vector<std::string> ignored;
  const auto placement = find_placement(character, 0, "", out.bind, ignored);
  if (!placement) return placement.error();
  out.matrix = placement->matrix();
  for (Mat4& m : out.bind) m = out.matrix * m;
  out.joints = find_joints(character);
  return out;
}

Quat rotation_of(const Mat4& m) {
  return decompose(m).rotation;
}

double leg_length(const Placed& p) {
  return (p.place(k_left + k_thigh) - p.place(k_left + k_shin)).norm() +
         (p.place(k_left + k_shin) - p.place(k_left + k_foot)).norm();
}

/// Turn about the vertical that takes the heading of one to the heading of the other.
Quat heading(const Placed& from, const Placed& to) {
  const auto side = [](const Placed& p) {
    Vec3 d = p.place(k_left + k_thigh) - p.place(k_right + k_thigh);
    d.y() = 0;
    return d.normalized();
  };
  const Vec3 a = side(from), b = side(to);
  return Quat(Eigen::AngleAxisd(std::atan2(a.cross(b).y(), a.dot(b)), Vec3::UnitY()));
}

}  // namespace

CommonJoints find_joints(const Character& character) {
  CommonJoints out;
  out.node.fill(-1);
  const auto find = [&](const std::string& name) {
    for (std::size_t i = 0; i < character.nodes.size(); ++i)
      if (plain_name(character.nodes[i].name) == name) return static_cast<int>(i);
    return -1;
  };
  const auto& rows = joint_rows();
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const char* name : rows[i].names) {
      if (out.node[i] < 0) out.node[i] = find(name);
      if (i < at(k_left)) continue;
      int& right = out.node[i + at(k_right - k_left)];
      if (right < 0) right = find(on_the_right(name));
    }
  for (const int side : {k_left, k_right})  // one name serves two joints
    if (out.node[at(side + k_shoulder)] == out.node[at(side + k_upper_arm)]) out.node[at(side + k_shoulder)] = -1;
  const auto relations = rows_of_joints();
  out.complete = true;
  for (int j = 0; j < k_common_joints; ++j) {
    const int node = out.node[at(j)], above = relations[at(j)].above;
    out.count += node >= 0;
    if (node >= 0 && above >= 0 && out.node[at(above)] >= 0 && !is_below(character, node, out.node[at(above)]))
      out.complete = false;
  }
  for (const int j : {0 + k_hips, k_left + k_upper_arm, k_left + k_thigh, k_left + k_shin, k_left + k_foot,
                      k_right + k_upper_arm, k_right + k_thigh, k_right + k_shin, k_right + k_foot})
    out.complete = out.complete && out.node[at(j)] >= 0;
  return out;
}

Status write_retargeted(const Character& source, const Clip& clip, const RetargetedPart& part, const Character& target,
                        const std::filesystem::path& file) {
  const auto from = place(source), to = place(target);
  if (!from) return from.error();
  if (!to) return to.error();
  if (!from->joints.complete || !to->joints.complete) return usage_error("the characters have no joints in common");
  const auto relations = rows_of_joints();
  const Quat turn = heading(*from, *to);
  const double scale = leg_length(*to) / leg_length(*from);

  // What takes a bone of the target's bind pose to the source's pose, before it moves.
  std::array<Quat, k_common_joints> line_up;
  line_up.fill(Quat::Identity());
  std::vector<int> joint_of_node(target.nodes.size(), -1);
  for (int j = 0; j < k_common_joints; ++j) {
    if (!from->has(j) || !to->has(j)) continue;
    joint_of_node[at(to->joints.node[at(j)])] = j;
    const int along = relations[at(j)].along;
    if (from->has(along) && to->has(along))
      line_up[at(j)] =
          Quat::FromTwoVectors(to->place(along) - to->place(j), turn * (from->place(along) - from->place(j)));
    if (j == k_left + k_hand || j == k_right + k_hand) line_up[at(j)] = line_up[at(relations[at(j)].above)];
  }

  Character out = target;
  out.clips.assign(1, Clip{clip.name, 0, 0, {}});
  const int hips = to->joints.node[k_hips];
  std::vector<int> channel_of_node(target.nodes.size(), -1);
  for (std::size_t i = 0; i < target.nodes.size(); ++i) {
    if (!is_below(target, static_cast<int>(i), hips)) continue;
    channel_of_node[i] = static_cast<int>(out.clips[0].channels.size());
    Channel channel;
    channel.node = static_cast<int>(i);
    channel.rotation.width = 4, channel.translation.width = 3;
    out.clips[0].channels.push_back(std::move(channel));
  }

  const ClipPose pose(source, &clip);
  std::vector<Mat4> locals(source.nodes.size()), posed(source.nodes.size());
  std::vector<double> morphs(pose.rest_morphs().begin(), pose.rest_morphs().end());
  std::vector<Quat> turned(target.nodes.size());
  for (int frame = 0; frame < part.frame_count; ++frame) {
    const double time = frame / part.fps;
    pose.sample(clip.start + part.start + time, locals, morphs);
    globals_from_locals(source.nodes, locals, posed);
    for (std::size_t i = 0; i < target.nodes.size(); ++i) {
      const int parent = target.nodes[i].parent, joint = joint_of_node[i];
      const Quat bind = rotation_of(to->bind[i]);
      const Quat above = parent < 0 ? rotation_of(to->matrix) : turned[at(parent)];
      const Quat above_bind = parent < 0 ? rotation_of(to->matrix) : rotation_of(to->bind[at(parent)]);
      turned[i] = above * (above_bind.inverse() * bind);
      if (joint >= 0) {
        const int node = from->joints.node[at(joint)];
        const Quat moved = rotation_of(from->matrix * posed[at(node)]) * rotation_of(from->bind[at(node)]).inverse();
        turned[i] = turn * moved * turn.inverse() * line_up[at(joint)] * bind;
      }
      if (channel_of_node[i] < 0) continue;
      Channel& channel = out.clips[0].channels[at(channel_of_node[i])];
      const Quat local = (above.inverse() * turned[i]).normalized();
      channel.rotation.times.push_back(time);
      channel.rotation.values.insert(channel.rotation.values.end(), {local.x(), local.y(), local.z(), local.w()});
      if (static_cast<int>(i) != hips) continue;
      const Vec3 was = (from->matrix * posed[at(from->joints.node[k_hips])]).topRightCorner<3, 1>();
      const Mat4 frame_above = parent < 0 ? to->matrix : to->bind[at(parent)];
      const Vec3 local_place = (frame_above.inverse() * (scale * (turn * was)).homogeneous()).head<3>();
      channel.translation.times.push_back(time);
      channel.translation.values.insert(channel.translation.values.end(), local_place.data(), local_place.data() + 3);
    }
  }
  out.clips[0].find_range();
  // glTF is in metres, and who reads it changes lengths to the target's unit.
  Mat4 unit = Mat4::Identity();
  if (target.file_unit > 0) unit.topLeftCorner<3, 3>() *= target.file_unit;
  const auto bytes = glb_from_character(out, 0, unit, out.notes);
  if (!bytes) return bytes.error();
  return write_file_durably(file, *bytes);
}

}  // namespace ft::bench
