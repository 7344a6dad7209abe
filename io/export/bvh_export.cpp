#include "io/export/bvh_export.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "baker/core/file.h"
#include "io/import/bvh/bvh_file.h"
#include "io/import/character/pose.h"

namespace ft::inline io {
namespace {

constexpr double k_degree = std::numbers::pi / 180;
/// Below this a change is the importer's rounding to 32 bits, and below the last digit that is written [units,
/// degrees].
constexpr double k_same = 1e-6;

struct Edit {
  std::size_t value;  ///< into BvhFile::values
  double now;
};

Status edit_position(const BvhFile& file, const BvhJoint& joint, const Channel* source, const Track& track,
                     std::vector<Edit>& edits) {
  bool any = false;
  for (std::size_t c = 0; c < joint.channels.size(); ++c) {
    if (joint.channels[c].path != BvhPath::k_position) continue;
    any = true;
    for (std::size_t f = 0; f < file.frame_count; ++f) {
      std::array<double, 3> was{}, now{};
      sample_track(source->translation, source->translation.times[f], false, was);
      sample_track(track, source->translation.times[f], false, now);
      const std::size_t value = f * file.values_per_frame + joint.first_value + c;
      const std::size_t axis = at(joint.channels[c].axis);
      const double old = file.numbers[value], next = old + (now[axis] - was[axis]);  // whether or not OFFSET is in it
      if (std::abs(next - old) > k_same * (1 + std::abs(old))) edits.push_back({value, next});
    }
  }
  return any ? Status() : Status(input_error("has no position channels"));
}

Status edit_rotation(const BvhFile& file, const BvhJoint& joint, const Channel* source, const Track& track,
                     std::vector<Edit>& edits) {
  std::vector<std::size_t> places;
  std::array<int, 3> axes{};
  for (std::size_t c = 0; c < joint.channels.size(); ++c)
    if (joint.channels[c].path == BvhPath::k_rotation && places.size() < 3) {
      axes[places.size()] = joint.channels[c].axis;
      places.push_back(joint.first_value + c);
    }
  if (places.size() != 3 || axes[0] == axes[1] || axes[1] == axes[2] || axes[0] == axes[2])
    return input_error("does not turn about three axes");
  for (std::size_t f = 0; f < file.frame_count; ++f) {
    std::array<double, 4> was{}, now{};
    sample_track(source->rotation, source->rotation.times[f], true, was);
    sample_track(track, source->rotation.times[f], true, now);
    const Quat q(now[3], now[0], now[1], now[2]);
    if (q.angularDistance(Quat(was[3], was[0], was[1], was[2])) < k_same) continue;
    Vec3 old;
    for (int k = 0; k < 3; ++k) old[k] = file.numbers[f * file.values_per_frame + places[at(k)]] * k_degree;
    const Vec3 angles = euler_angles(q, axes, old);
    for (int k = 0; k < 3; ++k)
      if (std::abs(angles[k] - old[k]) > k_same * k_degree)
        edits.push_back({f * file.values_per_frame + places[at(k)], angles[k] / k_degree});
  }
  return {};
}

Result<std::vector<Edit>> find_edits(const BvhFile& file, const Character& character, const Clip& clip,
                                     std::span<const ChangedChannel> changes) {
  bool same = file.joints.size() <= character.nodes.size();  // a body that was built has its node behind them
  for (std::size_t j = 0; same && j < file.joints.size(); ++j)
    same = file.joints[j].name.empty() || file.joints[j].name == character.nodes[j].name;
  if (!same) return input_error("its joints are not the nodes of the imported character");
  std::vector<Edit> edits;
  for (const ChangedChannel& change : changes) {
    const std::string where = "joint \"" + character.nodes[at(change.node)].name + "\"";
    if (at(change.node) >= file.joints.size()) return input_error("is not in the file", where);
    const BvhJoint& joint = file.joints[at(change.node)];
    const Channel* source = find_channel(clip, change.node);
    if (change.path == ChannelPath::k_scale) return input_error("cannot be scaled: BVH has no channel for it", where);
    const bool turns = change.path == ChannelPath::k_rotation;
    if (source == nullptr || track_of(*source, change.path).times.size() != file.frame_count)
      return input_error("has not the keys of the imported character", where);
    Status s = turns ? edit_rotation(file, joint, source, change.track, edits)
                     : edit_position(file, joint, source, change.track, edits);
    if (!s) return input_error(s.error().what, where);
  }
  std::sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.value < b.value; });
  return edits;
}

}  // namespace

Vec3 euler_angles(const Quat& rotation, const std::array<int, 3>& axes, const Vec3& near) {
  const Vec3 a = rotation.toRotationMatrix().eulerAngles(axes[0], axes[1], axes[2]);
  constexpr double k_pi = std::numbers::pi;
  const auto nearest = [&](const Vec3& angles) {
    Vec3 out;
    for (int k = 0; k < 3; ++k) out[k] = angles[k] + 2 * k_pi * std::round((near[k] - angles[k]) / (2 * k_pi));
    return out;
  };
  const Vec3 one = nearest(a), other = nearest(Vec3(a[0] + k_pi, k_pi - a[1], a[2] + k_pi));
  return (one - near).squaredNorm() <= (other - near).squaredNorm() ? one : other;
}

Result<std::string> export_bvh(const std::filesystem::path& source, const Character& character, int clip,
                               std::span<const ChangedChannel> changes) {
  auto text = read_text(source);
  if (!text) return text.error();
  if (changes.empty()) return std::move(*text);
  if (Status s = check_changes(character, clip, changes); !s) return s.error();
  const auto located = [&](const Error& e) {
    return input_error(e.what, source.string() + (e.where.empty() ? "" : ", " + e.where), e.hint);
  };
  auto file = read_bvh(*text);
  if (!file) return located(file.error());
  auto edits = find_edits(*file, character, character.clips[at(clip)], changes);
  if (!edits) return located(edits.error());
  std::string out;
  const char* copied = text->data();
  for (const Edit& edit : *edits) {
    const std::string_view old = file->values[edit.value];
    out.append(copied, old.data());
    out += fmt::format("{:.6f}", edit.now);
    copied = old.data() + old.size();
  }
  out.append(copied, static_cast<const char*>(text->data() + text->size()));
  return out;
}

}  // namespace ft::inline io
