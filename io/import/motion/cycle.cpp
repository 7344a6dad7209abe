// A cycle ends one step of a 32-bit float before the next begins: keys of a track cannot share a time, and files hold
// times as 32-bit numbers.
#include "io/import/motion/cycle.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/import/character/cut_track.h"
#include "io/import/motion/adjust.h"
#include "io/import/motion/cycle_curves.h"
#include "io/import/motion/run_up.h"

namespace ft::inline io {
namespace {

constexpr double k_rounding = 1e-6;  ///< of the size, and rad: what a step may be by rounding alone

std::vector<Mat4> globals_at(const Character& character, const ClipPose& pose, double time,
                             std::vector<double>& morphs) {
  std::vector<Mat4> locals(character.nodes.size()), globals(character.nodes.size());
  morphs.resize(pose.rest_morphs().size());
  pose.sample(time, locals, morphs);
  globals_from_locals(character.nodes, locals, globals);
  return globals;
}

Cycle cycle_of(const PlacedCharacter& placed, const Clip& clip, double size) {
  const ClipPose pose(placed.character, &clip);
  std::vector<double> start_morphs, end_morphs;
  const auto start = globals_at(placed.character, pose, clip.start, start_morphs);
  const auto end = globals_at(placed.character, pose, clip.end, end_morphs);
  const auto p = at(placed.pelvis);
  const NodeTransform from = decompose(placed.placement * start[p]), to = decompose(placed.placement * end[p]);
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
  step.linear() = Eigen::AngleAxisd(heading((to.rotation * from.rotation.inverse()).toRotationMatrix()), Vec3::UnitY())
                      .toRotationMatrix();
  step.translation() = to.translation - step.linear() * from.translation;
  step.translation().y() = 0;
  Cycle out = make_cycle(clip.duration(), step, size);
  std::vector<Vec3> first(placed.skin.base.size()), last(first.size());
  deform(placed.skin, placed.placement, start, start_morphs, first);
  deform(placed.skin, placed.placement, end, end_morphs, last);
  for (std::size_t v = 0; v < first.size(); ++v) out.seam = std::max(out.seam, (out.step * first[v] - last[v]).norm());
  return out;
}

/// What a cycle does to the tracks of a root, in its parent's space.
struct RootStep {
  Mat3 linear = Mat3::Identity();
  Quat rotation = Quat::Identity();
  Vec3 translation = Vec3::Zero();
};

/// Appends the keys of one cycle, which lie from `begin` to `end` in the file, `later` [s] later; `moved` changes a
/// value, and `turned` a tangent.
template <class Moved, class Turned>
void append_cycle(Track& out, const Track& in, double begin, double end, double later, Moved moved, Turned turned) {
  const bool cubic = in.interpolation == KeyInterpolation::k_cubic;
  const auto width = static_cast<std::size_t>(in.width), stride = in.stride();
  const auto push = [&](double time, std::size_t key, bool before, bool after) {
    out.times.push_back(time);
    const double* values = in.values.data() + key * stride;
    const auto part = [&](std::size_t which, bool there, auto change) {
      std::vector<double> v(values + which * width, values + (which + 1) * width);
      if (!there) std::fill(v.begin(), v.end(), 0.0);
      change(v);
      out.values.insert(out.values.end(), v.begin(), v.end());
    };
    if (cubic) part(0, before, turned);
    part(cubic ? 1 : 0, true, moved);
    if (cubic) part(2, after, turned);
  };
  const std::size_t count = in.times.size();
  if (in.times.front() > begin) push(begin + later, 0, false, false);
  for (std::size_t k = 0; k < count; ++k) push(in.times[k] + later, k, k > 0, k + 1 < count);
  if (in.times.back() < end) push(end + later, count - 1, false, false);
}

void no_change(std::vector<double>&) {}

Track constant_track(const std::vector<double>& value, double time) {
  Track out;
  out.width = static_cast<int>(value.size());
  out.times = {time}, out.values = value;
  return out;
}

class Repeat {
 public:
  Repeat(const Clip& clip, const Cycle& cycle, const CycleSpan& span) : clip_(clip), cycle_(cycle), span_(span) {}

  Clip whole() const {
    Clip out{.name = clip_.name, .start = clip_.start + at_cycle(span_.first), .end = clip_.end + at_cycle(span_.last)};
    out.stacks = clip_.stacks, out.shapes = clip_.shapes, out.curves = clip_.curves;
    for (Curve& curve : out.curves.curves) curve = repeated_curve(curve, curves());
    out.has_own_range = true;
    return out;
  }

  RepeatedSpan curves() const { return {clip_.start, cycle_.period, span_.first, span_.last}; }

  Track repeated(const Track& track, bool rotation = false) const {
    if (track.times.size() <= 1) return track;
    return each(track, rotation, [](long) { return std::pair{&no_change, &no_change}; });
  }
  Track moved(const Track& track, const std::vector<RootStep>& steps) const {
    return each(track, false, [&](long n) {
      const RootStep& s = steps[static_cast<std::size_t>(n - span_.first)];
      const auto turn = [&s](std::vector<double>& v) { store(s.linear * Vec3(v[0], v[1], v[2]), v); };
      const auto move = [&s](std::vector<double>& v) { store(s.linear * Vec3(v[0], v[1], v[2]) + s.translation, v); };
      return std::pair{move, turn};
    });
  }
  Track turned(const Track& track, const std::vector<RootStep>& steps) const {
    return each(track, true, [&](long n) {
      const Quat& q = steps[static_cast<std::size_t>(n - span_.first)].rotation;
      const auto turn = [&q](std::vector<double>& v) {  // of tangents, too: the product is linear
        const Quat out = q * Quat(v[3], v[0], v[1], v[2]);
        v = {out.x(), out.y(), out.z(), out.w()};
      };
      return std::pair{turn, turn};
    });
  }

 private:
  double at_cycle(long n) const { return static_cast<double>(n) * cycle_.period; }
  static void store(const Vec3& from, std::vector<double>& to) { to = {from.x(), from.y(), from.z()}; }
  template <class Changes>
  Track each(const Track& track, bool rotation, Changes changes) const {
    Track out;
    out.interpolation = track.interpolation, out.width = track.width;
    for (long n = span_.first; n <= span_.last; ++n) {
      const auto [move, turn] = changes(n);
      const double later = at_cycle(n), next = std::nextafter(static_cast<float>(clip_.end + later), -1e30f);
      const double end = n < span_.last ? std::max(next - later, clip_.start) : clip_.end;
      append_cycle(out, cut_track(track, clip_.start, end, rotation), clip_.start, end, later, move, turn);
    }
    return out;
  }

  const Clip& clip_;
  const Cycle& cycle_;
  const CycleSpan& span_;
};

/// Per cycle of the span, for a node whose parent stands where `parent` says [file units].
Result<std::vector<RootStep>> root_steps(const Cycle& cycle, const CycleSpan& span, const Mat4& world_of_parent) {
  std::vector<RootStep> out;
  const Mat4 inverse = world_of_parent.inverse();
  for (long n = span.first; n <= span.last; ++n) {
    const Mat4 local = inverse * cycle.steps(n).matrix() * world_of_parent;
    RootStep step;
    step.linear = local.topLeftCorner<3, 3>();
    step.translation = local.topRightCorner<3, 1>();
    if (!local.allFinite() || !(step.linear * step.linear.transpose()).isApprox(Mat3::Identity(), 1e-6))
      return usage_error("its root turns below a node that is scaled unequally: the clip cannot be carried on");
    step.rotation = Quat(step.linear).normalized();
    out.push_back(step);
  }
  return out;
}

Status carry_root(const PlacedCharacter& placed, const Clip& clip, const Repeat& repeat, const Cycle& cycle,
                  const CycleSpan& span, int root, Clip& out) {
  const ClipPose pose(placed.character, &clip);
  std::vector<double> morphs;
  const auto globals = globals_at(placed.character, pose, clip.start, morphs);
  const CharacterNode& node = placed.character.nodes[at(root)];
  const Mat4 parent = node.parent < 0 ? placed.placement : Mat4(placed.placement * globals[at(node.parent)]);
  const auto steps = root_steps(cycle, span, parent);
  if (!steps) return steps.error();
  const auto stack =
      std::find_if(out.stacks.begin(), out.stacks.end(), [&](const TransformStack& s) { return s.node == root; });
  if (stack != out.stacks.end()) {
    std::vector<Vec3> translations;
    std::vector<Quat> rotations;
    for (const RootStep& step : *steps) translations.push_back(step.translation), rotations.push_back(step.rotation);
    place_cycles(repeat.curves(), translations, rotations, *stack, out.curves);
  }
  const NodeTransform rest = decompose(node.local);
  const Channel* own = find_channel(clip, root);
  auto channel =
      std::find_if(out.channels.begin(), out.channels.end(), [&](const Channel& c) { return c.node == root; });
  if (stack != out.stacks.end() && own == nullptr) return {};
  if (channel == out.channels.end()) {
    out.channels.emplace_back().node = root;
    channel = std::prev(out.channels.end());
  }
  const Vec3& t = rest.translation;
  const Quat& q = rest.rotation;
  if (stack != out.stacks.end()) {  // what the channel has no keys for, the stack says
    if (!own->translation.empty()) channel->translation = repeat.moved(own->translation, *steps);
    if (!own->rotation.empty()) channel->rotation = repeat.turned(own->rotation, *steps);
    return {};
  }
  channel->translation =
      repeat.moved(own != nullptr && !own->translation.empty() ? own->translation
                                                               : constant_track({t.x(), t.y(), t.z()}, clip.start),
                   *steps);
  channel->rotation =
      repeat.turned(own != nullptr && !own->rotation.empty() ? own->rotation
                                                             : constant_track({q.x(), q.y(), q.z(), q.w()}, clip.start),
                    *steps);
  return {};
}

}  // namespace

Eigen::Isometry3d Cycle::steps(long n) const {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity(), power = step;
  for (; n > 0; n /= 2, power = power * power)
    if (n % 2 != 0) out = out * power;
  return out;
}

Cycle make_cycle(double period, const Eigen::Isometry3d& step, double size) {
  Cycle out;
  out.period = period;
  out.step = step;
  if (step.translation().norm() <= k_rounding * size && Eigen::AngleAxisd(step.linear()).angle() <= k_rounding)
    out.step.setIdentity();
  return out;
}

CycleSpan cycles_of_shot(const Cycle& cycle, const ImportRequest& request) {
  CycleSpan out;
  const double rounding = 1e-6 * request.speed / request.shot_fps;
  const double end = request.clip_start + request.duration * request.speed;
  out.first = std::max(0L, static_cast<long>(std::floor((request.clip_start + rounding) / cycle.period)));
  // The speed at the first frame is looked at a little behind it, which may be behind a short shot's end.
  out.last =
      std::max(out.first, static_cast<long>(std::floor((end + k_speed_interval * request.speed) / cycle.period)));
  out.seam_count = std::max(0L, static_cast<long>(std::floor((end + rounding) / cycle.period)) - out.first);
  for (long n = 1; n <= out.seam_count && out.seam_frames.size() < k_most_seams; ++n) {
    const double later = static_cast<double>(out.first + n) * cycle.period - request.clip_start;  // s of the clip
    const double frame = std::ceil(later / request.speed * request.shot_fps - 1e-6);
    out.seam_frames.push_back(request.first_frame + static_cast<int>(frame));
  }
  return out;
}

std::string cycle_note(const Cycle& cycle, const CycleSpan& span, double size) {
  const auto rounded = [](double value) { return std::round(1e3 * value) / 1e3 + 0.0; };  // and no -0
  const double turn = rounded(heading(cycle.step.linear()) * 180 / std::numbers::pi);
  std::string out = fmt::format("its clip of {:.4g} s repeats: ", cycle.period);
  if (cycle.step.isApprox(Eigen::Isometry3d::Identity(), 0))
    out += "it stays in place";
  else
    out += fmt::format("each cycle goes on {:.4g} m along the ground and turns by {:.3g} degrees",
                       cycle.step.translation().norm(), turn);
  out += fmt::format("; at the seam the end of a cycle and the start of the next are up to {:.3g} mm apart",
                     rounded(1e3 * cycle.seam));
  if (span.seam_frames.empty()) return out + "; the shot ends before it";
  if (!(cycle.seam > k_large_seam * size)) return out;
  constexpr std::size_t k_most = 8;
  std::string frames;
  for (std::size_t i = 0; i < span.seam_frames.size() && i < k_most; ++i)
    frames += fmt::format("{}{}", i == 0 ? "" : ", ", span.seam_frames[i]);
  if (span.seam_count > static_cast<long>(k_most))
    frames += fmt::format(" and {} more", span.seam_count - static_cast<long>(k_most));
  return out + fmt::format(": the body jumps into frame{} {}; export a clip that ends as it begins",
                           span.seam_count > 1 ? "s" : "", frames);
}

Status repeat_clip(PlacedCharacter& placed, const std::vector<int>& meshes, double size, const ImportRequest& request) {
  Character& character = placed.character;
  const Clip& clip = character.clips[at(placed.clip)];
  const Cycle cycle = cycle_of(placed, clip, size);
  const CycleSpan span = cycles_of_shot(cycle, request);
  placed.info.notes.push_back(cycle_note(cycle, span, size));
  placed.info.seam_frames = span.seam_frames;
  if (span.last == 0) return {};
  std::size_t keys = 0;
  for (const Channel& channel : clip.channels)
    for (const Track* track : {&channel.translation, &channel.rotation, &channel.scale, &channel.weights})
      keys += track->values.size();
  for (const Curve& curve : clip.curves.curves)
    keys += std::max(curve.times.size(), static_cast<std::size_t>(3 * k_curve_samples * cycle.period));  // with jumps
  const auto count = static_cast<std::size_t>(span.last - span.first + 1);
  if (keys > k_max_character_keys / count)
    return usage_error(fmt::format("its clip repeats {} times, which is more than {} million keys", count,
                                   k_max_character_keys / 1'000'000),
                       request.file.string(), "bake the shot in parts: --frames");
  const Repeat repeat(clip, cycle, span);
  Clip out = repeat.whole();
  for (const Channel& channel : clip.channels) {
    Channel& to = out.channels.emplace_back();
    to.node = channel.node;
    to.translation = repeat.repeated(channel.translation), to.rotation = repeat.repeated(channel.rotation, true);
    to.scale = repeat.repeated(channel.scale), to.weights = repeat.repeated(channel.weights);
  }
  if (!cycle.step.isApprox(Eigen::Isometry3d::Identity(), 0))
    for (const int root : motion_roots(character, placed.clip, meshes))
      if (Status s = carry_root(placed, clip, repeat, cycle, span, root, out); !s)
        return Error{s.error().kind, s.error().what, request.file.string(), s.error().hint};
  character.clips[at(placed.clip)] = std::move(out);
  placed.repeated = true;
  return {};
}

}  // namespace ft::inline io
