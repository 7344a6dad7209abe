// An interval is the time between two frames. It is a jump when the motion in it is unlike the motion in the interval
// before and unlike the one after: a start, a stop, a crash is like one of the two. Medians over the body's vertices,
// so that limbs do not count; a jump that the source's frame rate spreads over two intervals is looked for as well.
#include "io/import/repair/teleport_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>

#include "baker/core/parallel.h"
#include "baker/core/rigid.h"
#include "io/import/repair/jump_limits.h"

namespace ft::inline io {
namespace {

/// The same as least_jump() about an axis [rad/s2].
constexpr double k_angular_acceleration = 1500;
constexpr double k_least_turn = std::numbers::pi / 3;  ///< rad
/// A body that turns on the spot moves most of its points by more than this share of its size; a kick only seems to
/// turn it.
constexpr double k_turning_share = 0.03;
/// The body's velocity before and after differs by this when the cut leads into another motion [m/s]; less is its
/// acceleration.
constexpr double k_other_motion = 2;
constexpr int k_trimming_rounds = 6;
constexpr std::size_t k_most_vertices = 256;  ///< looked at in every frame

/// What is remembered of a frame.
struct FrameRecord {
  std::vector<Vec3> points;  ///< thinned vertices
  std::vector<Vec3> parts;   ///< middle of each part
};

using Motion = std::vector<Vec3>;  ///< displacement of each point over an interval

Motion between(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  Motion out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = b[i] - a[i];
  return out;
}

double median_difference(const Motion& a, const Motion& b, double times) {
  std::vector<double> d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) d[i] = (a[i] - times * b[i]).norm();
  const auto middle = d.begin() + static_cast<std::ptrdiff_t>(d.size() / 2);
  std::nth_element(d.begin(), middle, d.end());
  return *middle;
}

Vec3 mean(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// The rigid motion that brings points nearest to others (Kabsch 1976); `used`: their indices.
Eigen::Isometry3d rigid_fit(const std::vector<Vec3>& from, const std::vector<Vec3>& to, std::span<const int> used) {
  Vec3 from_middle = Vec3::Zero(), to_middle = Vec3::Zero();
  const double count = static_cast<double>(used.size());
  for (const int i : used) from_middle += from[at(i)] / count, to_middle += to[at(i)] / count;
  Mat3 covariance = Mat3::Zero();
  for (const int i : used) covariance += (to[at(i)] - to_middle) * (from[at(i)] - from_middle).transpose();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = nearest_rotation(covariance);
  out.translation() = to_middle - out.linear() * from_middle;
  return out;
}

/// The same for the half of the points that moves most alike: limbs have no say (least trimmed squares, Rousseeuw
/// 1984).
Eigen::Isometry3d trunk_fit(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  std::vector<int> used(from.size());
  std::iota(used.begin(), used.end(), 0);
  Eigen::Isometry3d fit = rigid_fit(from, to, used);
  std::vector<double> miss(from.size());
  for (int round = 0; round < k_trimming_rounds; ++round) {
    for (std::size_t i = 0; i < from.size(); ++i) miss[i] = (fit * from[i] - to[i]).squaredNorm();
    used.resize(from.size());
    std::iota(used.begin(), used.end(), 0);
    std::sort(used.begin(), used.end(),
              [&](int a, int b) { return miss[at(a)] < miss[at(b)] || (miss[at(a)] == miss[at(b)] && a < b); });
    used.resize(std::max<std::size_t>(3, from.size() / 2));
    used.resize(std::min(used.size(), from.size()));
    std::sort(used.begin(), used.end());
    fit = rigid_fit(from, to, used);
  }
  return fit;
}

double angle_between(const Mat3& a, const Mat3& b) {
  return Eigen::AngleAxisd(Mat3(a * b.transpose())).angle();
}

class Scan {
 public:
  Scan(const Trajectory& trajectory, const TeleportScanSettings& settings)
      : trajectory_(trajectory), settings_(settings) {
    first_ = settings.first_frame - settings.preroll_frames;
    count_ = at(settings.last_frame - first_ + 1);
    std::vector<Vec3> bind(at(trajectory.surface().vertex_count()));
    trajectory.bind_pose(bind);
    size_ = bounds(bind).size().maxCoeff();
    dt_ = 1 / settings.fps;
  }

  TeleportScan run() {
    TeleportScan out;
    if (count_ < 2) return out;
    jumps_.assign(count_ - 1, 0);
    if (settings_.detect) {
      record();
      find_jumps();
      find_part_jumps(out);
    }
    for (const int frame : settings_.frames)
      if (frame > first_ && frame <= settings_.last_frame) jumps_[at(frame - first_ - 1)] = 1;
    for (std::size_t i = 0; i + 1 < count_; ++i)
      if (jumps_[i]) out.teleports.push_back(measure(i, out));
    return out;
  }

 private:
  double time_of(std::size_t k) const { return (first_ + static_cast<int>(k) - settings_.first_frame) / settings_.fps; }

  std::vector<Vec3> sample(std::size_t k) const {
    std::vector<Vec3> x(at(trajectory_.surface().vertex_count()));
    trajectory_.sample(time_of(k), x);
    return x;
  }

  void record() {
    const Surface& surface = trajectory_.surface();
    const std::size_t vertices = at(surface.vertex_count()),
                      stride = std::max<std::size_t>(1, vertices / k_most_vertices);
    std::vector<double> members(surface.parts.size(), 0.0);
    for (const int part : surface.part_of_vertex) ++members[at(part)];
    frames_.resize(count_);
    parallel_tasks(count_, [&](std::size_t k) {
      const std::vector<Vec3> x = sample(k);
      FrameRecord& r = frames_[k];
      r.parts.assign(surface.parts.size(), Vec3::Zero());
      for (std::size_t v = 0; v < vertices; ++v) {
        if (v % stride == 0) r.points.push_back(x[v]);
        r.parts[at(surface.part_of_vertex[v])] += x[v];
      }
      for (std::size_t p = 0; p < r.parts.size(); ++p) r.parts[p] /= std::max(members[p], 1.0);
    });
    for (std::size_t i = 0; i + 1 < count_; ++i) {
      moves_.push_back(between(frames_[i].points, frames_[i + 1].points));
      turns_.push_back(trunk_fit(frames_[i].points, frames_[i + 1].points).linear());
    }
  }

  /// The body's motion over `length` intervals from `begin` against `length` times the motion before and after.
  bool is_jump(std::size_t begin, std::size_t length) const {
    const Motion whole = between(frames_[begin].points, frames_[begin + length].points);
    const double times = static_cast<double>(length), time = times * dt_;
    double moved = std::numeric_limits<double>::infinity(), turned = moved;
    const Mat3 turn = trunk_fit(frames_[begin].points, frames_[begin + length].points).linear();
    const auto compare = [&](std::size_t other) {
      moved = std::min(moved, median_difference(whole, moves_[other], times));
      turned = std::min(turned, angle_between(turn, length == 1 ? turns_[other] : Mat3(turns_[other] * turns_[other])));
    };
    if (begin > 0) compare(begin - 1);
    if (begin + length < moves_.size()) compare(begin + length);
    if (!std::isfinite(moved)) return false;  // nothing to compare with
    return moved > least_jump(size_, time) ||
           (turned > std::max(k_least_turn, 0.25 * k_angular_acceleration * time * time) &&
            moved > k_turning_share * size_);
  }

  void find_jumps() {
    for (std::size_t i = 0; i < moves_.size(); ++i) jumps_[i] = is_jump(i, 1);
    for (std::size_t i = 0; i + 1 < moves_.size(); ++i)
      if (!jumps_[i] && !jumps_[i + 1] && is_jump(i, 2)) jumps_[i] = jumps_[i + 1] = 1;
  }

  void find_part_jumps(TeleportScan& out) const {
    const auto& parts = trajectory_.surface().parts;
    const double least = k_limb_jump * least_jump(size_, dt_);
    for (std::size_t i = 0; i + 1 < count_; ++i) {
      if (jumps_[i] || (i > 0 && jumps_[i - 1]) || (i + 2 < count_ && jumps_[i + 1])) continue;
      PartJump jump;
      const Vec3 body = mean(moves_[i]);
      for (std::size_t p = 0; p < parts.size(); ++p) {
        const auto move = [&](std::size_t k) -> Vec3 {
          return frames_[k + 1].parts[p] - frames_[k].parts[p] - mean(moves_[k]);
        };
        const Vec3 now = frames_[i + 1].parts[p] - frames_[i].parts[p] - body;
        if (now.norm() <= least) continue;
        double moved = std::numeric_limits<double>::infinity();
        if (i > 0) moved = std::min(moved, (now - move(i - 1)).norm());
        if (i + 1 < moves_.size()) moved = std::min(moved, (now - move(i + 1)).norm());
        if (!(moved > least) || !std::isfinite(moved)) continue;
        ++jump.part_count;
        if (now.norm() > jump.distance) jump.distance = now.norm(), jump.part = parts[p].name;
      }
      jump.frame = first_ + static_cast<int>(i) + 1;
      if (jump.part_count > 0) out.part_jumps.push_back(std::move(jump));
    }
  }

  /// Fits the jump itself, without the body's own motion in the meantime: from the middle of the interval as the motion
  /// before foretells it to the middle as the motion after has it. The body's acceleration is in both and cancels.
  Teleport measure(std::size_t i, TeleportScan& out) const {
    const bool before = i > 0 && !jumps_[i - 1], after = i + 2 < count_ && !jumps_[i + 1];
    std::vector<Vec3> from = sample(i), to = sample(i + 1);
    Motion earlier, later;
    if (before) earlier = between(sample(i - 1), from);
    if (after) later = between(to, sample(i + 2));
    const double share = before && after ? 0.5 : 1.0;
    for (std::size_t v = 0; v < from.size(); ++v) {
      if (before) from[v] += share * earlier[v];
      if (after) to[v] -= share * later[v];
    }
    Teleport t;
    t.frame = first_ + static_cast<int>(i) + 1;
    t.motion = trunk_fit(from, to);
    if (before && after) {
      const Vec3 change = (mean(later) - t.motion.linear() * mean(earlier)) / dt_;
      if (change.norm() > k_other_motion) t.velocity_change = change;
    }
    const Vec3 middle = mean(from);
    out.distances.push_back((t.motion * middle - middle).norm());
    out.turns.push_back(angle_between(t.motion.linear(), Mat3::Identity()));
    return t;
  }

  const Trajectory& trajectory_;
  const TeleportScanSettings& settings_;
  int first_ = 0;             ///< frame of the first record
  std::size_t count_ = 0;     ///< frames
  double size_ = 0, dt_ = 0;  ///< m, s
  std::vector<FrameRecord> frames_;
  std::vector<Motion> moves_;  ///< of each interval
  std::vector<Mat3> turns_;    ///< of each interval
  std::vector<char> jumps_;    ///< of each interval
};

}  // namespace

TeleportScan scan_teleports(const Trajectory& trajectory, const TeleportScanSettings& settings) {
  return Scan(trajectory, settings).run();
}

std::vector<std::string> teleport_notes(const TeleportScan& scan, const std::string& primary, std::size_t most) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < scan.teleports.size(); ++i) {
    const int frame = scan.teleports[i].frame;
    const double turn_deg = scan.turns[i] * 180 / std::numbers::pi;
    out.push_back(fmt::format("primary \"{}\" jumps {:.2f} m{} between frames {} and {}: the cloth is carried along",
                              primary, scan.distances[i],
                              turn_deg >= 1 ? fmt::format(" and turns {:.0f} degrees", turn_deg) : std::string(),
                              frame - 1, frame));
  }
  for (const PartJump& jump : scan.part_jumps)
    out.push_back(fmt::format(
        "primary \"{}\": part \"{}\"{} jumps {:.2f} m between frames {} and {} and the body does not: "
        "nothing can be carried along, look at these frames",
        primary, jump.part, jump.part_count > 1 ? fmt::format(" (one of {})", jump.part_count) : std::string(),
        jump.distance, jump.frame - 1, jump.frame));
  if (out.size() > most) {
    const std::size_t more = out.size() - most;
    out.resize(most);
    out.push_back(fmt::format("primary \"{}\": {} more jumps", primary, more));
  }
  return out;
}

}  // namespace ft::inline io
