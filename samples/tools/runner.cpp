#include "samples/tools/runner.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "samples/tools/figure.h"

namespace ft::sets {
namespace {

/// Where a foot is in the swing: its ball against the hip joint's place on the ground, for a figure 1.7 m tall.
struct Key {
  double phase;  ///< share of the stride since touch-down
  double z, y;   ///< m, forwards, up
  double foot;   ///< degrees, toes up
};
/// From toe-off to touch-down: the heel comes up behind, the knee goes forward, the shin swings out.
constexpr std::array<Key, 7> k_swing{{{0.34, -0.37, 0.034, -52},
                                      {0.45, -0.60, 0.28, -92},
                                      {0.58, -0.36, 0.40, -98},
                                      {0.70, 0.06, 0.32, -68},
                                      {0.82, 0.43, 0.24, -25},
                                      {0.92, 0.48, 0.155, 3},
                                      {1.00, 0.34, 0.034, 0}}};

/// Cubic through the keys; slopes are those of the chord between neighbours, at both ends as given.
double spline(double phase, double Key::*what, double first_slope, double last_slope) {
  std::size_t i = 0;
  while (i + 2 < k_swing.size() && k_swing[i + 1].phase < phase) ++i;
  const auto slope = [&](std::size_t k) {
    if (k == 0) return first_slope;
    if (k + 1 == k_swing.size()) return last_slope;
    return (k_swing[k + 1].*what - k_swing[k - 1].*what) / (k_swing[k + 1].phase - k_swing[k - 1].phase);
  };
  const double h = k_swing[i + 1].phase - k_swing[i].phase, s = (phase - k_swing[i].phase) / h;
  const double a = k_swing[i].*what, b = k_swing[i + 1].*what;
  return a + (b - a) * s * s * (3 - 2 * s) + h * s * (1 - s) * (slope(i) * (1 - s) - slope(i + 1) * s);
}

class Runner {
 public:
  explicit Runner(const RunnerSettings& settings)
      : settings_(settings), figure_(settings.height), scale_(settings.height / 1.7) {}

  std::string text() const {
    std::vector<Pose> poses;
    for (int sample = 0; sample / settings_.fps <= settings_.seconds; ++sample) poses.push_back(pose(sample));
    return figure_.bvh(poses, settings_.fps);
  }

 private:
  struct Foot {
    Vec3 ball = Vec3::Zero();    ///< m, against the hip joint's place on the ground
    double pitch = 0, toes = 0;  ///< rad
  };

  Foot foot(double phase) const {
    const double back = -settings_.speed * settings_.stride / scale_;  // of what stands still, by the stride
    Foot out;
    if (phase < settings_.support) {
      const double roll = std::pow(std::max(0.0, phase / settings_.support - 0.3) / 0.7, 2);
      out.ball = Vec3(0, k_swing.front().y, k_swing.back().z + back * phase);
      out.pitch = roll * k_swing.front().foot * k_rad;
      out.toes = -out.pitch;
    } else {
      const Key &first = k_swing.front(), &last = k_swing.back();
      const double way = (phase - settings_.support) / (1 - settings_.support);
      const double at = first.phase + way * (last.phase - first.phase);
      const double from = last.z + back * settings_.support - first.z;  // where this stride leaves the ground
      out.ball = Vec3(0, spline(at, &Key::y, 0.6, -2.2),
                      spline(at, &Key::z, back, 0.4 * back) + from * (1 - smooth(0, 0.5, way)));
      out.pitch = spline(at, &Key::foot, -450, 0) * k_rad;
      out.toes = -first.foot * k_rad * (1 - smooth(0, 0.3, way));
    }
    out.ball *= scale_;
    return out;
  }

  Pose pose(int sample) const {
    const double t = sample / settings_.fps, stride = settings_.start + t / settings_.stride,
                 turn = 2 * std::numbers::pi;
    Pose out;
    // Highest in the middle of the flight, lowest over the foot.
    const double flight = 0.5 * (settings_.support + 0.5);
    const double hip = scale_ * (0.788 + 0.025 * std::cos(2 * turn * (stride - flight)));
    out.tilt = -5 * k_rad;
    out.lean = (-6 + 1.5 * std::cos(2 * turn * (stride - 0.1))) * k_rad;
    // Left knee forward: the pelvis turns to the right, the chest to the left.
    const double knee = std::cos(turn * (stride - 0.86));
    out.pelvis_turn = -7 * k_rad * knee;
    out.chest_turn = 14 * k_rad * knee;
    out.hips = Vec3(0.012 * scale_ * std::cos(turn * (stride - 0.17)), hip + figure_.hip_drop(), settings_.speed * t);
    for (const std::size_t side : {0, 1}) {
      double phase = stride + (side == 0 ? 0 : 0.5);
      phase -= std::floor(phase);
      step(out, side, foot(phase));
      swing_arm(out, side, std::cos(turn * (phase - 0.38)));
    }
    return out;
  }

  void step(Pose& pose, std::size_t side, const Foot& foot) const {
    const double a = figure_.thigh(), b = figure_.shin();
    const Vec3 ankle = foot.ball - pitch(-foot.pitch) * figure_.ball() + Vec3(0, 0, pose.hips.z());
    Vec3 way = ankle - figure_.hip_joint(pose, static_cast<int>(side));
    way.x() = 0;
    const double far = std::clamp(way.norm(), 1.02 * std::abs(a - b), 0.998 * (a + b));
    const double at_hip = std::acos((a * a + far * far - b * b) / (2 * a * far));
    const double at_knee = std::acos((a * a + b * b - far * far) / (2 * a * b));
    pose.thigh[side] = std::atan2(way.z(), -way.y()) + at_hip;
    pose.shin[side] = pose.thigh[side] - (std::numbers::pi - at_knee);
    pose.foot[side] = foot.pitch;
    pose.toes[side] = foot.toes;
  }

  /// `forward`: 1 with the hand before the chest, -1 with it beside the hip.
  void swing_arm(Pose& pose, std::size_t side, double forward) const {
    const double sign = side == 0 ? 1 : -1, s = 0.5 * (forward + 1);
    const Vec3 back(0.26, 0.09, -0.03), front(0.13, 0.36, 0.34);
    Vec3 grip = back + s * (front - back);
    grip.y() -= 0.12 * s * (1 - s);
    pose.grip[side] = pose.hips + scale_ * Vec3(sign * grip.x(), grip.y(), grip.z());
    pose.elbows = Vec3(0.75, -0.6, -1);
  }

  RunnerSettings settings_;
  Figure figure_;
  double scale_;
};

}  // namespace

std::string runner_bvh(const RunnerSettings& settings) {
  return Runner(settings).text();
}

}  // namespace ft::sets
