#include "io/import/motion/figure_bind.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "io/import/body/body.h"
#include "io/import/body/t_pose.h"
#include "io/import/character/pose.h"

namespace ft::inline io {
namespace {

constexpr double k_stands = -0.4, k_folded = 0.5;  ///< trunk_to_legs() below and above
constexpr int k_most_samples = 48;                 ///< poses of a clip that are looked at
/// Of the length of all bones, the share that points one way in a skeleton whose rest pose is no figure, if it
/// branches.
constexpr double k_one_way = 0.9;
constexpr int k_branches = 4;

std::vector<Mat4> globals_at(const Character& character, const ClipPose& pose, double time) {
  std::vector<Mat4> locals(character.nodes.size()), globals(locals.size());
  std::vector<double> morphs(pose.rest_morphs().size());
  pose.sample(time, locals, morphs);
  globals_from_locals(character.nodes, locals, globals);
  return globals;
}

/// Four or more ends, and nearly all bones point the same way.
bool is_bundle(const Character& character, const std::vector<Mat4>& globals) {
  Vec3 sum = Vec3::Zero();
  double length = 0;
  std::vector<char> goes_on(globals.size(), 0);
  for (std::size_t i = 0; i < globals.size(); ++i) {
    const int parent = character.nodes[i].parent;
    if (parent < 0) continue;
    goes_on[at(parent)] = 1;
    const Vec3 bone = (globals[i] - globals[at(parent)]).topRightCorner<3, 1>();
    sum += bone, length += bone.norm();
  }
  return std::count(goes_on.begin(), goes_on.end(), 0) >= k_branches && sum.norm() > k_one_way * length;
}

bool is_folded(const Character& character, const Figure& figure, const std::vector<Mat4>& globals) {
  if (!figure.has_trunk()) return is_bundle(character, globals);
  const auto cosine = trunk_to_legs(character, figure, globals);
  const bool has_knees = figure.legs[0].lower >= 0 && figure.legs[1].lower >= 0;
  return cosine ? *cosine > k_folded : has_knees;  // legs that point opposite ways are folded, too
}

struct Standing {
  std::vector<Mat4> globals;
  double cosine = 2;          ///< trunk_to_legs()
  Vec3 trunk = Vec3::Zero();  ///< mean direction over the clip
};

Standing most_upright(const Character& character, const Clip& clip, const Figure& figure) {
  Standing out;
  const ClipPose pose(character, &clip);
  const int count = clip.duration() > 0 ? k_most_samples : 1;
  for (int k = 0; k < count; ++k) {
    auto globals = globals_at(character, pose, clip.start + clip.duration() * k / std::max(1, count - 1));
    const auto cosine = trunk_to_legs(character, figure, globals);
    const Vec3 trunk = trunk_of(figure, globals);
    if (!cosine || !trunk.allFinite()) continue;
    if (*cosine < k_stands) out.trunk += trunk.normalized();
    if (*cosine < out.cosine - 0.02) out.cosine = *cosine, out.globals = std::move(globals);
  }
  return out;
}

/// The nodes of one tree in a T-pose, with the figure where it rests.
Result<BindPose> stand(const Character& character, const Clip* clip, const Figure& figure, const BindPose& rest,
                       const std::string& up) {
  BindPose from = rest;
  Vec3 trunk = Vec3::UnitY();
  if (clip != nullptr)
    if (const Standing standing = most_upright(character, *clip, figure); !standing.globals.empty()) {
      const Vec3 move = (rest.globals[at(figure.base)] - standing.globals[at(figure.base)]).topRightCorner<3, 1>();
      trunk = standing.trunk.norm() > 0 ? standing.trunk : trunk_of(figure, standing.globals);
      for (std::size_t i = 0; i < character.nodes.size(); ++i) {
        if (!is_within(character, static_cast<int>(i), figure.base)) continue;
        from.globals[i] = standing.globals[i];
        from.globals[i].topRightCorner<3, 1>() += move;
      }
    }
  auto axes = axes_from_up(up.empty() ? main_axis(trunk) : up);
  if (!axes) return axes.error();
  BindPose out = t_pose(character, figure, from, *axes, TPoseFrom::k_any);
  for (std::size_t i = 0; i < character.nodes.size(); ++i) {
    const int parent = character.nodes[i].parent;
    out.locals[i] = parent < 0 ? out.globals[i] : Mat4(out.globals[at(parent)].inverse() * out.globals[i]);
  }
  return out;
}

}  // namespace

Result<std::optional<BindPose>> standing_pose(const Character& character, const Clip* clip, const std::string& up,
                                              std::vector<std::string>& notes) {
  BindPose pose = find_bind_pose(character);
  const std::vector<Mat4> rest = pose.globals;
  bool changed = false, known = true;
  for (int root = 0; root < static_cast<int>(rest.size()); ++root) {
    if (character.nodes[at(root)].parent >= 0) continue;
    const Figure figure = find_figure(character, root);
    if (!is_folded(character, figure, rest)) continue;
    if (figure.has_trunk()) {
      auto stood = stand(character, clip, figure, pose, up);
      if (!stood) return stood.error();
      pose = std::move(*stood);
    } else if (clip != nullptr) {
      known = false;
      pose.globals = globals_at(character, ClipPose(character, clip), clip->start);
    } else {
      continue;
    }
    changed = true;
    if (!known) break;
  }
  if (!changed) return std::optional<BindPose>();
  notes.emplace_back(known ? "its joints do not rest as a figure: the body, and what it wears, is modelled on a T-pose "
                             "made from the skeleton"
                           : "its joints do not rest as a figure and their names are not known: the body, and what it "
                             "wears, is modelled on the clip's first pose");
  return std::optional<BindPose>(std::move(pose));
}

Result<BindPose> asked_t_pose(const Character& character, const BindPose& bind, const Mat3& axes,
                              const std::string& file, std::vector<std::string>& notes) {
  const Figure figure = find_figure(character);
  if (const std::vector<std::string> missing = figure.missing(); !missing.empty()) {
    std::string list;
    for (const std::string& joint : missing) list += (list.empty() ? "" : ", ") + joint;
    return usage_error("bind = \"t_pose\": not found among the joints: " + list, file,
                       "joints are known by names such as LeftUpLeg, LeftLeg, LeftFoot, LeftArm, LeftForeArm, LeftHand "
                       "or thigh_l, calf_l, foot_l; without bind garments are modelled on the pose of the file");
  }
  const auto cosine = trunk_to_legs(character, figure, bind.globals);
  const double lean = (axes * trunk_of(figure, bind.globals)).normalized().y();
  const bool stands = cosine && *cosine < k_stands && lean > 0.7;
  BindPose out = t_pose(character, figure, bind, axes, stands ? TPoseFrom::k_standing : TPoseFrom::k_any);
  notes.emplace_back("garments are modelled on a T-pose made from the skeleton (bind = \"t_pose\")");
  return out;
}

Result<Placement> place_bind_pose(Character& character, const Clip* clip, const ImportRequest& request, BindPose& bind,
                                  std::vector<std::string>& notes) {
  const std::string name = request.file.string();
  const bool bare = character.meshes.empty() && character.format == "BVH";
  bool made = false;
  bind = find_bind_pose(character);
  if (bare) {
    auto stands = standing_pose(character, clip, request.up, notes);
    if (!stands) return stands.error();
    if (*stands) bind = std::move(**stands), made = true;
  }
  auto placement = find_placement(character, request.unit_scale, request.up, bind.globals, notes);
  if (!placement) return placement;
  if (!request.bind.empty()) {
    auto asked = asked_t_pose(character, bind, placement->axes, name, notes);
    if (!asked) return asked.error();
    bind = std::move(*asked);
  }
  if (!bare) return placement;
  if (Status s = add_body(character, request.body, placement->axes, bind.globals); !s)
    return Error{s.error().kind, s.error().what, name, s.error().hint};
  const BindPose without = std::move(bind);
  bind = find_bind_pose(character);
  if (!request.bind.empty()) {  // the body was built with its legs apart perhaps
    std::copy(without.globals.begin(), without.globals.end(), bind.globals.begin());
    std::copy(without.locals.begin(), without.locals.end(), bind.locals.begin());
    made = true;
  }
  if (made) bind.from_inverse_binds = false;  // which is no surprise then
  notes.push_back("has no body; one was built from the skeleton (" + request.body + ")");
  return placement;
}

}  // namespace ft::inline io
