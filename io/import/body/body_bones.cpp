#include "io/import/body/body_bones.h"

#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

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
    case Limb::k_upper_arm: return {0.033, 0.025};
    case Limb::k_forearm: return {0.026, 0.0175};
    case Limb::k_hand: return {0.019, 0.018};
    case Limb::k_finger: return {0.016, 0.013};
    case Limb::k_other: return {0.025, 0.020};
  }
  return {0.025, 0.020};
}

/// Half depth and half breadth of the torso, from the hip joints (0) to the shoulder joints (1).
struct Section {
  double at, depth, breadth;
};
constexpr Section k_torso[] = {{0.0, 0.060, 0.096},  {0.22, 0.058, 0.086}, {0.42, 0.053, 0.075},
                               {0.70, 0.064, 0.087}, {0.87, 0.057, 0.085}, {1.0, 0.040, 0.066}};

bool is_end(const Character& character, std::size_t joint) {
  return is_end_site(character.nodes[joint]);
}

class FleshBuilder {
 public:
  FleshBuilder(const Character& character, const BodyFrame& frame)
      : character_(character),
        frame_(frame),
        limb_(limbs_by_name(character)),
        marks_(find_landmarks(character, frame, limb_)),
        of_many_(limb_.size(), 0) {
    for (std::size_t i = 0; i < limb_.size(); ++i) {
      if (limb_[i] != Limb::k_finger) continue;
      const auto parent = static_cast<std::size_t>(std::max(character.nodes[i].parent, 0));
      const auto& beside = frame.children[parent];
      const auto fingers =
          std::count_if(beside.begin(), beside.end(), [&](int n) { return limb(n) == Limb::k_finger; });
      of_many_[i] = of_many_[parent] || fingers >= 4;
    }
  }

  std::vector<BodyBone> build() {
    for (std::size_t i = 0; i < limb_.size(); ++i) {
      if (!frame_.members[i]) continue;
      const int joint = static_cast<int>(i);
      if (limb_[i] == Limb::k_head && !is_end(character_, i)) {
        const int parent = character_.nodes[i].parent;
        if (parent < 0 || limb(parent) != Limb::k_head) add_head(joint, at(joint), at(joint) + to_top(joint));
        continue;
      }
      for (const int child : frame_.children[i]) add_bone(joint, child);
      add_stub(joint);
    }
    if (marks_.complete) add_torso();
    return std::move(out_);
  }

 private:
  const Vec3& at(int joint) const { return frame_.joints[static_cast<std::size_t>(joint)]; }
  Limb limb(int joint) const { return limb_[static_cast<std::size_t>(joint)]; }
  Vec3 middle(const std::vector<int>& pair) const { return 0.5 * (at(pair[0]) + at(pair[1])); }

  void add_bone(int joint, int child) {
    const Vec3 &a = at(joint), &b = at(child);
    if ((b - a).norm() < 1e-4) return;
    Radii r = radii(limb(joint));
    switch (limb(joint)) {
      case Limb::k_hips:
      case Limb::k_torso:
      case Limb::k_hip_joint:
        if (!marks_.complete) add(joint, a, b, r.at_joint, r.at_end);
        return;  // else the torso is built as one
      case Limb::k_collar: return add_collar(joint, a, b);
      case Limb::k_thigh:
        if (marks_.complete) {  // narrow hips: the legs stay apart below the crotch
          const Vec3 centre = middle(marks_.thighs);
          r.at_joint = std::min(r.at_joint, 1.15 * std::abs((a - centre).dot(marks_.side)));
          r.at_end = std::min(r.at_end, 0.8 * std::abs((b - centre).dot(marks_.side)));
        }
        break;
      case Limb::k_shin: {
        const Vec3 calf = a + 0.28 * (b - a) - 0.004 * marks_.forward;
        add(joint, a, calf, r.at_joint, 0.035);
        return add(joint, calf, b, 0.035, r.at_end);
      }
      case Limb::k_finger:
        if (of_many_[static_cast<std::size_t>(joint)]) r = {0.0095, 0.008};
        break;
      case Limb::k_foot:  // heel
        add(joint, a, a - 0.018 * marks_.forward - Vec3(0, 0.008, 0), 0.024, 0.022);
        break;
      default: break;
    }
    add(joint, a, b, r.at_joint, r.at_end);
  }

  /// From a head's joint to its top: its end, else of its children (eyes, jaw) the one that goes on as the neck does.
  Vec3 to_top(int head) const {
    Vec3 best = Vec3::Zero();
    double most = -std::numeric_limits<double>::infinity();
    const int parent = character_.nodes[static_cast<std::size_t>(head)].parent;
    const Vec3 up = parent >= 0 ? Vec3(at(head) - at(parent)) : Vec3::UnitY().eval();
    for (const int child : frame_.children[static_cast<std::size_t>(head)]) {
      const bool end = is_end(character_, static_cast<std::size_t>(child)) || limb(child) == Limb::k_head;
      const double along = (at(child) - at(head)).dot(up) + (end ? 1e3 : 0);
      if (along > most) most = along, best = at(child) - at(head);
    }
    return best;
  }

  /// What a joint without a bone behind it has: hand, foot and toes go on.
  void add_stub(int joint) {
    const auto& below = frame_.children[static_cast<std::size_t>(joint)];
    const int parent = character_.nodes[static_cast<std::size_t>(joint)].parent;
    const bool goes_on =
        std::any_of(below.begin(), below.end(), [&](int child) { return (at(child) - at(joint)).norm() >= 1e-4; });
    if (goes_on || parent < 0 || is_end(character_, static_cast<std::size_t>(joint))) return;
    const Vec3 &a = at(joint), way = a - at(parent);
    if (limb(joint) == Limb::k_hand && way.norm() > 1e-4) add(joint, a, a + 0.065 * way.normalized(), 0.019, 0.015);
    if (limb(joint) == Limb::k_foot && marks_.complete)
      add(joint, a, a + 0.11 * marks_.forward - Vec3(0, 0.015, 0), 0.024, 0.018);
    if (limb(joint) == Limb::k_toe && marks_.complete) add(joint, a, a + 0.03 * marks_.forward, 0.018, 0.015);
  }

  void add_collar(int joint, const Vec3& a, const Vec3& b) {
    if (!marks_.complete) return add(joint, a, b, 0.040, 0.034);
    const Vec3 shoulders = middle(marks_.arms);
    add(joint, shoulders + 0.25 * (b - shoulders) + Vec3(0, 0.010, 0), b, 0.034, 0.034);
  }

  /// Two lobes side by side from the hip joints to the shoulders, with the bones of the spine each moving its own
  /// height; the hips between and behind the hip joints.
  void add_torso() {
    const Vec3 low = middle(marks_.thighs) - 0.010 * marks_.forward,
               high = middle(marks_.arms) + 0.012 * marks_.forward;
    const auto lobe = [&](const Section& s, double sign) -> Vec3 {
      return low + s.at * (high - low) + sign * (s.breadth - s.depth) * marks_.side;
    };
    for (std::size_t k = 0; k + 1 < std::size(k_torso); ++k) {
      const Section &s = k_torso[k], &t = k_torso[k + 1];
      const double height = low.y() + 0.5 * (s.at + t.at) * (high.y() - low.y());
      int owner = marks_.hips;
      for (const int joint : marks_.spine)
        if (at(joint).y() <= height) owner = joint;
      for (const double sign : {1.0, -1.0}) add(owner, lobe(s, sign), lobe(t, sign), s.depth, t.depth);
    }
    for (const int thigh : marks_.thighs) {
      const Vec3 out = (at(thigh) - middle(marks_.thighs)).dot(marks_.side) * marks_.side;
      const Vec3 inner = middle(marks_.thighs) + out * std::min(1.0, 0.042 / std::max(out.norm(), 1e-6));
      add(marks_.hips, middle(marks_.thighs), inner, 0.052, 0.052);
      const Vec3 seat = inner - 0.026 * marks_.forward;
      add(marks_.hips, seat + Vec3(0, 0.020, 0), seat - Vec3(0, 0.012, 0), 0.048, 0.048);
    }
  }

  void add_head(int joint, const Vec3& a, const Vec3& b) {
    const Vec3 up = (b - a).norm() > 0.01 ? (b - a).normalized() : Vec3::UnitY().eval();
    const Vec3 front = (marks_.forward - marks_.forward.dot(up) * up).normalized();
    const Vec3 skull = a + 0.046 * up;
    add(joint, skull + 0.006 * front, skull - 0.012 * front, 0.049, 0.049);
    add(joint, a + 0.006 * up + 0.022 * front, skull + 0.018 * front, 0.030, 0.042);
    add(joint, a - 0.01 * up, a + 0.02 * up, 0.033, 0.036);
  }

  void add(int node, const Vec3& a, const Vec3& b, double radius_a, double radius_b) {
    out_.push_back({node, a, b, radius_a, radius_b});
  }

  const Character& character_;
  const BodyFrame& frame_;
  std::vector<Limb> limb_;
  Landmarks marks_;
  std::vector<char> of_many_;  ///< fingers of a hand that has four or more: as thin as fingers are
  std::vector<BodyBone> out_;
};

}  // namespace

std::vector<BodyBone> flesh(const Character& character, const BodyFrame& frame) {
  return FleshBuilder(character, frame).build();
}

std::vector<BodyBone> links(const BodyFrame& frame) {
  std::vector<BodyBone> out;
  for (std::size_t i = 0; i < frame.children.size(); ++i)
    for (const int child : frame.children[i])
      if (frame.members[i])
        out.push_back(
            {static_cast<int>(i), frame.joints[i], frame.joints[static_cast<std::size_t>(child)], 0.026, 0.026});
  return out;
}

std::vector<BodyBone> capsules(const Character& character, const BodyFrame& frame) {
  const std::vector<Limb> limb = limbs_by_name(character);
  std::vector<BodyBone> out;
  for (std::size_t i = 0; i < limb.size(); ++i)
    for (const int child : frame.children[i]) {
      if (!frame.members[i]) continue;
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

}  // namespace ft::inline io
