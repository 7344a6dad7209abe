#include "io/import/motion/character_trajectory.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "io/import/motion/run_up.h"

namespace ft::inline io {
double heading(const Mat3& rotation) {
  const Quat q(rotation);
  if (q.w() * q.w() + q.y() * q.y() < 0.02) return 0;
  return 2 * std::atan2(q.y(), q.w());
}

CharacterTrajectory::CharacterTrajectory(std::shared_ptr<const Character> character, const Clip* clip, Skin skin,
                                         BindPose bind, int pelvis, const Mat4& placement, const Playback& playback)
    : character_(std::move(character)),
      skin_(std::move(skin)),
      bind_(std::move(bind)),
      pose_(*character_, clip),
      placement_(placement),
      playback_(playback) {
  const auto& nodes = character_->nodes;
  std::vector<Mat4> locals(nodes.size()), globals(nodes.size());
  start_morphs_.resize(pose_.rest_morphs().size());
  pose_.sample(playback_.start, locals, start_morphs_);
  globals_from_locals(nodes, locals, globals);

  const auto p = static_cast<std::size_t>(pelvis);
  const NodeTransform from = decompose(placement_ * bind_.globals[p]), to = decompose(placement_ * globals[p]);
  bind_to_start_.linear() =
      Eigen::AngleAxisd(heading((to.rotation * from.rotation.inverse()).toRotationMatrix()), Vec3::UnitY())
          .toRotationMatrix();
  bind_to_start_.translation() = to.translation - bind_to_start_.linear() * from.translation;

  std::vector<double> morphs(start_morphs_.size());
  std::vector<Mat4> later(nodes.size());
  pose_.sample(playback_.start + k_speed_interval * playback_.speed, later, morphs);
  std::vector<Mat4> later_globals(nodes.size());
  globals_from_locals(nodes, later, later_globals);
  start_velocity_ = (decompose(placement_ * later_globals[p]).translation - to.translation) / k_speed_interval;

  const Mat4 moved = placement_.inverse() * bind_to_start_.matrix() * placement_;
  std::vector<char> below(nodes.size(), 0);
  blends_.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const int parent = nodes[i].parent;
    below[i] = parent >= 0 && (parent == pelvis || below[static_cast<std::size_t>(parent)]);
    blends_[i].in_parent = below[i] != 0;
    blends_[i].from = decompose(below[i] ? bind_.locals[i] : Mat4(moved * bind_.globals[i]));
    blends_[i].to = decompose(below[i] ? locals[i] : globals[i]);
  }
}

void CharacterTrajectory::globals_at(double time, std::vector<Mat4>& globals, std::vector<double>& morphs) const {
  const auto& nodes = character_->nodes;
  globals.resize(nodes.size());
  morphs.resize(start_morphs_.size());
  if (time >= 0 || playback_.preroll <= 0) {
    std::vector<Mat4> locals(nodes.size());
    pose_.sample(playback_.start + std::max(time, 0.0) * playback_.speed, locals, morphs);
    globals_from_locals(nodes, locals, globals);
    return;
  }
  const double weight = blend_weight(time, playback_.preroll);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Mat4 m = blend(blends_[i].from, blends_[i].to, weight).matrix();
    globals[i] = blends_[i].in_parent ? Mat4(globals[static_cast<std::size_t>(nodes[i].parent)] * m) : m;
  }
  const auto rest = pose_.rest_morphs();
  for (std::size_t k = 0; k < morphs.size(); ++k) morphs[k] = rest[k] + weight * (start_morphs_[k] - rest[k]);
}

Eigen::Isometry3d CharacterTrajectory::bind_to_start() const {
  return Eigen::Translation3d(run_up_offset(start_velocity_, -playback_.preroll, playback_.preroll)) * bind_to_start_;
}

void CharacterTrajectory::bind_pose(std::span<Vec3> positions) const {
  deform(skin_, placement_, bind_.globals, pose_.rest_morphs(), positions);
}

void CharacterTrajectory::sample(double time, std::span<Vec3> positions) const {
  std::vector<Mat4> globals;
  std::vector<double> morphs;
  globals_at(time, globals, morphs);
  deform(skin_, placement_, globals, morphs, positions);
  const Vec3 offset = run_up_offset(start_velocity_, time, playback_.preroll);
  if (offset != Vec3::Zero())
    for (Vec3& p : positions) p += offset;
}

}  // namespace ft::inline io
