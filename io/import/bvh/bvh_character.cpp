#include "io/import/bvh/bvh_character.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "baker/core/file.h"
#include "io/import/bvh/bvh_words.h"

namespace ft::inline io {
namespace {

constexpr double k_degree = std::numbers::pi / 180;
/// Lengths of bones in the OFFSETs and in the motion that differ by more are of two skeletons, or of two units.
constexpr double k_other_length = 1.5;

class CharacterMaker {
 public:
  explicit CharacterMaker(BvhFile file) : file_(std::move(file)), offsets_(file_.joints.size()) {
    for (std::size_t j = 0; j < offsets_.size(); ++j) offsets_[j] = file_.joints[j].offset;
    out_.format = "BVH";
    out_.file_unit = 0, out_.file_up.clear();
    out_.notes = std::move(file_.notes);
  }

  Character make() {
    if (file_.frame_count > 0) judge_positions();
    make_nodes();
    if (file_.frame_count > 0) make_clip();
    list_contents();
    return std::move(out_);
  }

 private:
  static bool has(const BvhJoint& joint, BvhPath path) {
    return std::any_of(joint.channels.begin(), joint.channels.end(),
                       [&](const BvhChannel& c) { return c.path == path; });
  }
  const double* values(const BvhJoint& joint, std::size_t frame) const {
    return file_.numbers.data() + frame * file_.values_per_frame + joint.first_value;
  }
  Vec3 position(std::size_t j, std::size_t frame) const {
    const BvhJoint& joint = file_.joints[j];
    const bool added = added_ && joint.parent >= 0;
    Vec3 out = offsets_[j];
    const double* v = values(joint, frame);
    for (std::size_t c = 0; c < joint.channels.size(); ++c)
      if (joint.channels[c].path == BvhPath::k_position)
        out[joint.channels[c].axis] = v[c] + (added ? offsets_[j][joint.channels[c].axis] : 0);
    return out;
  }

  /// What the position channels of joints below others mean, and whether the OFFSETs are the skeleton's.
  void judge_positions() {
    std::vector<std::size_t> placed;  // joints below others that have position channels
    for (std::size_t j = 0; j < offsets_.size(); ++j)
      if (file_.joints[j].parent >= 0 && has(file_.joints[j], BvhPath::k_position)) placed.push_back(j);
    int replaced = 0, near_zero = 0, with_offset = 0;
    std::vector<double> ratios;
    for (const std::size_t j : placed) {
      const double length = offsets_[j].norm(), moved = position(j, 0).norm();
      if (!(length > 0)) continue;
      ++with_offset;
      near_zero += moved < 0.5 * length && (position(j, 0) - offsets_[j]).norm() > 0.5 * length;
      if (moved > 0) ratios.push_back(moved / length);
    }
    added_ = 2 * near_zero > with_offset;
    bool other_size = false;
    if (!added_ && !ratios.empty()) {
      const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
      std::nth_element(ratios.begin(), middle, ratios.end());
      other_size = *middle > k_other_length || *middle < 1 / k_other_length;
    }
    for (const std::size_t j : placed) {
      if (added_ || (offsets_[j] != Vec3::Zero() && !other_size)) continue;
      const Vec3 first = position(j, 0);
      if (first == Vec3::Zero()) continue;
      ++replaced;
      offsets_[j] = first;
    }
    if (added_)
      out_.notes.push_back(fmt::format(
          "the position channels of {} joints are near 0 and their OFFSETs are not: added to them", placed.size()));
    if (replaced > 0)
      out_.notes.push_back(
          fmt::format("{} joints have {}: the skeleton's size and rest pose were taken from the "
                      "positions in the motion's first frame",
                      replaced, other_size ? "OFFSETs of another size than the motion" : "OFFSET 0"));
  }

  void make_nodes() {
    for (std::size_t j = 0; j < offsets_.size(); ++j) {
      const BvhJoint& joint = file_.joints[j];
      CharacterNode node;
      node.parent = joint.parent;
      node.name = joint.name.empty() ? "EndSite_" + file_.joints[at(joint.parent)].name : joint.name;
      node.local.topRightCorner<3, 1>() = offsets_[j];
      out_.nodes.push_back(std::move(node));
    }
  }

  void make_clip() {
    Clip clip;
    clip.name = "Motion";
    std::vector<double> times(file_.frame_count);
    for (std::size_t f = 0; f < times.size(); ++f) times[f] = static_cast<double>(f) * file_.frame_time;
    for (std::size_t j = 0; j < offsets_.size(); ++j) {
      const BvhJoint& joint = file_.joints[j];
      if (joint.channels.empty()) continue;
      Channel channel;
      channel.node = static_cast<int>(j);
      if (has(joint, BvhPath::k_position)) fill(channel.translation, 3, times), fill_positions(j, channel.translation);
      if (has(joint, BvhPath::k_rotation)) fill(channel.rotation, 4, times), fill_rotations(joint, channel.rotation);
      if (has(joint, BvhPath::k_scale)) fill(channel.scale, 3, times), fill_scales(joint, channel.scale);
      clip.channels.push_back(std::move(channel));
    }
    clip.find_range();
    out_.clips.push_back(std::move(clip));
  }

  static void fill(Track& track, int width, const std::vector<double>& times) {
    track.width = width;
    track.times = times;
    track.values.reserve(times.size() * static_cast<std::size_t>(width));
  }
  void fill_positions(std::size_t j, Track& track) const {
    for (std::size_t f = 0; f < file_.frame_count; ++f) {
      const Vec3 p = position(j, f);
      track.values.insert(track.values.end(), {p.x(), p.y(), p.z()});
    }
  }
  void fill_rotations(const BvhJoint& joint, Track& track) const {
    for (std::size_t f = 0; f < file_.frame_count; ++f) {
      const double* v = values(joint, f);
      Quat q = Quat::Identity();
      for (std::size_t c = 0; c < joint.channels.size(); ++c) {
        if (joint.channels[c].path != BvhPath::k_rotation) continue;
        const double half = 0.5 * k_degree * v[c];
        Quat turn(std::cos(half), 0, 0, 0);
        turn.vec()[joint.channels[c].axis] = std::sin(half);
        q = q * turn;
      }
      q.normalize();
      track.values.insert(track.values.end(), {q.x(), q.y(), q.z(), q.w()});
    }
  }
  void fill_scales(const BvhJoint& joint, Track& track) const {
    for (std::size_t f = 0; f < file_.frame_count; ++f) {
      const double* v = values(joint, f);
      Vec3 scale = Vec3::Ones();
      for (std::size_t c = 0; c < joint.channels.size(); ++c)
        if (joint.channels[c].path == BvhPath::k_scale) scale[joint.channels[c].axis] = v[c];
      track.values.insert(track.values.end(), {scale.x(), scale.y(), scale.z()});
    }
  }

  void list_contents() {
    std::int64_t joints = 0, ends = 0, roots = 0, placed = 0, scaled = 0;
    for (const BvhJoint& joint : file_.joints) {
      ends += joint.name.empty();
      joints += !joint.name.empty();
      roots += joint.parent < 0;
      placed += joint.parent >= 0 && has(joint, BvhPath::k_position);
      scaled += has(joint, BvhPath::k_scale);
    }
    out_.contents.push_back({"joints", joints, "used"});
    out_.contents.push_back({"end sites", ends, "used as the ends of bones"});
    if (roots > 1) out_.contents.push_back({"skeletons (ROOT)", roots, "used"});
    out_.contents.push_back({"frames", static_cast<std::int64_t>(file_.frame_count), "used as one clip"});
    if (placed > 0)
      out_.contents.push_back({"joints with position channels, below the root", placed,
                               added_ ? "used: added to their OFFSET" : "used: in place of their OFFSET"});
    if (scaled > 0) out_.contents.push_back({"joints with scale channels", scaled, "used"});
  }

  BvhFile file_;
  std::vector<Vec3> offsets_;
  bool added_ = false;  ///< positions to the OFFSETs
  Character out_;
};

}  // namespace

Character bvh_character(BvhFile file) {
  return CharacterMaker(std::move(file)).make();
}

bool is_bvh(const std::filesystem::path& file) {
  if (is_keyword(file.extension().string(), ".bvh")) return true;
  std::ifstream in(file, std::ios::binary);
  char head[64] = {};
  in.read(head, sizeof head);
  std::string_view text(head, static_cast<std::size_t>(in.gcount()));
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return is_keyword(BvhWords(text).next(), "hierarchy");
}

Result<Character> read_bvh_character(const std::filesystem::path& file) {
  auto text = read_text(file);
  if (!text) return text.error();
  auto read = read_bvh(*text, BvhSpelling::k_forget);
  if (!read) return read.error();
  return bvh_character(std::move(*read));
}

}  // namespace ft::inline io
