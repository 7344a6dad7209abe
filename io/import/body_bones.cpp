#include "io/import/body_bones.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/import/bind.h"

namespace ft {
namespace {

enum class Limb { k_hips, k_torso, k_neck, k_head, k_hip_joint, k_thigh, k_shin, k_foot, k_toe, k_collar, k_upper_arm, k_forearm, k_hand, k_finger, k_other };

struct Word {
  const char* text;
  Limb limb;
};
/// First match wins; "upleg" stands before "leg", "forearm" before "arm".
constexpr Word k_words[] = {
    {"hipjoint", Limb::k_hip_joint}, {"upleg", Limb::k_thigh},  {"upperleg", Limb::k_thigh}, {"thigh", Limb::k_thigh},
    {"femur", Limb::k_thigh},        {"shin", Limb::k_shin},    {"knee", Limb::k_shin},      {"calf", Limb::k_shin},
    {"lowleg", Limb::k_shin},        {"lowerleg", Limb::k_shin}, {"tibia", Limb::k_shin},    {"leg", Limb::k_shin},
    {"toe", Limb::k_toe},            {"foot", Limb::k_foot},    {"ankle", Limb::k_foot},     {"thumb", Limb::k_finger},
    {"finger", Limb::k_finger},      {"index", Limb::k_finger}, {"middle", Limb::k_finger},  {"ring", Limb::k_finger},
    {"pinky", Limb::k_finger},       {"handend", Limb::k_finger}, {"hand", Limb::k_hand},    {"wrist", Limb::k_hand},
    {"forearm", Limb::k_forearm},    {"lowerarm", Limb::k_forearm}, {"elbow", Limb::k_forearm}, {"radius", Limb::k_forearm},
    {"collar", Limb::k_collar},      {"clavicle", Limb::k_collar}, {"uparm", Limb::k_upper_arm}, {"upperarm", Limb::k_upper_arm},
    {"humerus", Limb::k_upper_arm},  {"shldr", Limb::k_upper_arm}, {"shoulder", Limb::k_collar}, {"arm", Limb::k_upper_arm},
    {"head", Limb::k_head},          {"neck", Limb::k_neck},    {"spine", Limb::k_torso},    {"chest", Limb::k_torso},
    {"back", Limb::k_torso},         {"abdomen", Limb::k_torso}, {"torso", Limb::k_torso},   {"thorax", Limb::k_torso},
    {"hip", Limb::k_hips},           {"pelvis", Limb::k_hips},  {"root", Limb::k_hips}};

std::string lower(const std::string& text) {
  std::string out;
  for (const char c : text) out.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  return out;
}

Limb limb_by_name(const std::string& name) {
  const std::string word = lower(name);
  for (const Word& w : k_words)
    if (word.find(w.text) != std::string::npos) return w.limb;
  return Limb::k_other;
}

/// Names, with two habits mended: "LeftHip - LeftKnee" means the thigh, "LeftShoulder - LeftElbow" the upper arm.
std::vector<Limb> limbs(const Character& character, const BodyFrame& frame) {
  std::vector<Limb> out;
  for (const CharacterNode& node : character.nodes) {
    const bool end = node.name.starts_with("EndSite");
    out.push_back(end && node.parent >= 0 ? out[static_cast<std::size_t>(node.parent)] : limb_by_name(node.name));
  }
  for (std::size_t i = 0; i < out.size(); ++i)
    for (const int child : frame.children[i]) {
      const Limb below = out[static_cast<std::size_t>(child)];
      if (out[i] == Limb::k_hips && below == Limb::k_shin) out[i] = Limb::k_thigh;
      if (out[i] == Limb::k_collar && below == Limb::k_forearm) out[i] = Limb::k_upper_arm;
    }
  return out;
}

struct Radii {
  double at_joint, at_end;
};
Radii radii(Limb limb) {
  switch (limb) {
    case Limb::k_hips: return {0.055, 0.055};
    case Limb::k_hip_joint: return {0.060, 0.054};
    case Limb::k_torso: return {0.062, 0.062};
    case Limb::k_neck: return {0.034, 0.032};
    case Limb::k_head: return {0.045, 0.052};
    case Limb::k_thigh: return {0.051, 0.034};
    case Limb::k_shin: return {0.033, 0.022};
    case Limb::k_foot: return {0.024, 0.021};
    case Limb::k_toe: return {0.020, 0.015};
    case Limb::k_collar: return {0.040, 0.034};
    case Limb::k_upper_arm: return {0.031, 0.025};
    case Limb::k_forearm: return {0.025, 0.018};
    case Limb::k_hand: return {0.018, 0.016};
    case Limb::k_finger: return {0.014, 0.012};
    case Limb::k_other: return {0.025, 0.020};
  }
  return {0.025, 0.020};
}

bool is_torso(Limb limb) { return limb == Limb::k_hips || limb == Limb::k_torso; }

/// Half depth and half breadth of the torso from the hips (0) to the base of the neck (1).
struct Section {
  double at, depth, breadth;
};
constexpr Section k_torso[] = {{0.0, 0.060, 0.092}, {0.4, 0.054, 0.077}, {0.72, 0.063, 0.090}, {0.9, 0.058, 0.092}, {1.0, 0.044, 0.070}};

Section torso_section(double at) {
  const Section* s = k_torso;
  while (s + 2 < std::end(k_torso) && at > s[1].at) ++s;
  const double u = std::clamp((at - s[0].at) / (s[1].at - s[0].at), 0.0, 1.0);
  return {at, s[0].depth + u * (s[1].depth - s[0].depth), s[0].breadth + u * (s[1].breadth - s[0].breadth)};
}

class FleshBuilder {
 public:
  FleshBuilder(const Character& character, const BodyFrame& frame) : frame_(frame), limb_(limbs(character, frame)) {
    for (std::size_t i = 0; i < limb_.size(); ++i) {
      if (hips_ < 0 && limb_[i] == Limb::k_hips) hips_ = static_cast<int>(i);
      if (neck_ < 0 && limb_[i] == Limb::k_neck) neck_ = static_cast<int>(i);
      if (limb_[i] == Limb::k_thigh && !character.nodes[i].name.starts_with("EndSite")) thighs_.push_back(static_cast<int>(i));
    }
    if (hips_ < 0) hips_ = 0;
    if (neck_ < 0)
      for (std::size_t i = 0; i < limb_.size() && neck_ < 0; ++i)
        if (limb_[i] == Limb::k_head) neck_ = static_cast<int>(i);
    if (thighs_.size() >= 2) side_ = at(thighs_[0]) - at(thighs_[1]);
    side_.y() = 0;
    side_ = side_.norm() > 1e-6 ? side_.normalized() : Vec3::UnitX().eval();
  }

  std::vector<BodyBone> build() {
    for (std::size_t i = 0; i < limb_.size(); ++i)
      for (const int child : frame_.children[i]) add_bone(static_cast<int>(i), child);
    if (thighs_.size() >= 2) {
      const double half = 0.5 * (at(thighs_[0]) - at(thighs_[1])).norm();
      const double r = 0.056;  // hip joints lie 0.036 inside the hip's outline
      out_.push_back({hips_, at(thighs_[0]) + side_ * std::max(0.0, 0.040 - half), at(thighs_[1]) - side_ * std::max(0.0, 0.040 - half), r, r});
    }
    return std::move(out_);
  }

 private:
  const Vec3& at(int joint) const { return frame_.joints[static_cast<std::size_t>(joint)]; }

  void add_bone(int joint, int child) {
    const Limb limb = limb_[static_cast<std::size_t>(joint)], below = limb_[static_cast<std::size_t>(child)];
    const Vec3 &a = at(joint), &b = at(child);
    const double length = (b - a).norm();
    if (limb == Limb::k_head) return add_head(joint, a, b);
    if (length < 1e-4) return;
    if (is_torso(limb)) {
      if (below == Limb::k_thigh || below == Limb::k_hip_joint) return add(joint, a, b, 0.058, 0.052);
      if (below == Limb::k_collar || below == Limb::k_upper_arm) return add(joint, a, b, 0.045, below == Limb::k_upper_arm ? 0.032 : 0.040);
      if (is_torso(below) || below == Limb::k_neck || below == Limb::k_head) return add_torso(joint, a, b);
    }
    Radii r = radii(limb);
    if (limb == Limb::k_thigh && thighs_.size() >= 2) {  // narrow hips: the legs stay apart below the crotch
      const double half_top = 0.5 * (at(thighs_[0]) - at(thighs_[1])).norm();
      r.at_joint = std::min(r.at_joint, 1.15 * half_top);
      r.at_end = std::min(r.at_end, 0.8 * std::abs((b - 0.5 * (at(thighs_[0]) + at(thighs_[1]))).dot(side_)));
    }
    if (limb == Limb::k_shin) {  // calf
      const Vec3 calf = a + 0.28 * (b - a);
      add(joint, a, calf, r.at_joint, 0.035);
      return add(joint, calf, b, 0.035, r.at_end);
    }
    if (limb == Limb::k_foot) {  // heel
      Vec3 forward = b - a;
      forward.y() = 0;
      if (forward.norm() > 1e-6) add(joint, a, a - 0.016 * forward.normalized() - Vec3(0, 0.004, 0), 0.025, 0.023);
    }
    add(joint, a, b, r.at_joint, r.at_end);
  }

  /// Two lobes beside the spine; the distance between them grows with the breadth.
  void add_torso(int joint, const Vec3& a, const Vec3& b) {
    const Vec3 base = at(hips_), top = neck_ >= 0 ? at(neck_) : b;
    const Vec3 axis = top - base;
    const double squared = std::max(axis.squaredNorm(), 1e-12);
    // Joints of the neck branch low in some skeletons; a bone's own ends bound its share.
    const Section low = torso_section((a - base).dot(axis) / squared), high = torso_section((b - base).dot(axis) / squared);
    for (const double sign : {1.0, -1.0})
      out_.push_back({joint, a + sign * (low.breadth - low.depth) * side_, b + sign * (high.breadth - high.depth) * side_, low.depth, high.depth});
  }

  void add_head(int joint, const Vec3& a, const Vec3& b) {
    const Vec3 up = (b - a).norm() > 0.01 ? (b - a).normalized() : Vec3::UnitY().eval();
    const Vec3 crown = a + up * std::max((b - a).norm(), 0.075);
    add(joint, a + 0.012 * up, crown - 0.020 * up, 0.040, 0.050);
  }

  void add(int node, const Vec3& a, const Vec3& b, double radius_a, double radius_b) { out_.push_back({node, a, b, radius_a, radius_b}); }

  const BodyFrame& frame_;
  std::vector<Limb> limb_;
  int hips_ = -1, neck_ = -1;
  std::vector<int> thighs_;
  Vec3 side_ = Vec3::UnitX();
  std::vector<BodyBone> out_;
};

}  // namespace

Result<BodyFrame> body_frame(const Character& character, const Mat3& axes) {
  BodyFrame frame;
  frame.axes = axes;
  frame.children.resize(character.nodes.size());
  Box box;
  for (const Mat4& m : rest_globals(character)) {
    frame.joints.push_back(axes * m.topRightCorner<3, 1>());
    box.include(frame.joints.back());
  }
  for (std::size_t i = 0; i < character.nodes.size(); ++i)
    if (const int parent = character.nodes[i].parent; parent >= 0) frame.children[static_cast<std::size_t>(parent)].push_back(static_cast<int>(i));
  const double height = box.size().y();
  if (!(height > 1e-9) || !(box.size().norm() < 20 * height))
    return input_error("no body can be built: the skeleton has no height in its rest pose", "", "check up = ..., or use a file with a mesh");
  frame.scale = 1 / height;
  for (Vec3& p : frame.joints) p *= frame.scale;
  return frame;
}

std::vector<BodyBone> flesh(const Character& character, const BodyFrame& frame) { return FleshBuilder(character, frame).build(); }

std::vector<BodyBone> capsules(const Character& character, const BodyFrame& frame) {
  const std::vector<Limb> limb = limbs(character, frame);
  std::vector<BodyBone> out;
  for (std::size_t i = 0; i < limb.size(); ++i)
    for (const int child : frame.children[i]) {
      const Vec3 &a = frame.joints[i], &b = frame.joints[static_cast<std::size_t>(child)];
      if ((b - a).norm() < 0.018) continue;
      const Radii r = radii(limb[i]);
      const double fuller = limb[i] == Limb::k_torso || limb[i] == Limb::k_hips ? 1.25 : 1.1;
      out.push_back({static_cast<int>(i), a, b, fuller * r.at_joint, fuller * r.at_end});
    }
  return out;
}

double capsule_distance(const BodyBone& bone, const Vec3& p) {
  const Vec3 axis = bone.b - bone.a;
  const double squared = axis.squaredNorm();
  const double u = squared > 0 ? std::clamp((p - bone.a).dot(axis) / squared, 0.0, 1.0) : 0;
  return (p - bone.a - u * axis).norm() - (bone.radius_a + u * (bone.radius_b - bone.radius_a));
}

}  // namespace ft
