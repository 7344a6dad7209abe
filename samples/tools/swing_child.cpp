// The child of make_set's swing.
#include <algorithm>
#include <cmath>

#include "samples/tools/figure.h"
#include "samples/tools/swing.h"
#include "samples/tools/swing_times.h"

namespace ft::sets {
namespace {

class Child {
 public:
  explicit Child(const SwingSettings& settings)
      : settings_(settings), figure_(settings.child), angles_(swing_angles(settings)) {}

  std::string text() const {
    std::vector<Pose> poses;
    for (std::size_t sample = 0; sample < angles_.size(); ++sample) poses.push_back(pose(sample));
    return figure_.bvh(poses, settings_.fps);
  }

 private:
  /// Between -1, backwards, and 1, forwards at full speed; ahead of the motion, as children are.
  double pumping(std::size_t sample) const {
    const std::size_t ahead = static_cast<std::size_t>(0.15 * settings_.fps);
    const std::size_t a = std::min(sample + ahead, angles_.size() - 2);
    const double fastest = std::sqrt(k_gravity / settings_.length) * settings_.swing_deg * k_rad;
    return std::tanh(2 * (angles_[a + 1] - angles_[a]) * settings_.fps / fastest);
  }

  /// A place that goes with the swing: above the board, and in front of the ropes.
  Vec3 on_swing(double angle, double side, double above, double before) const {
    return Vec3(0, settings_.length + settings_.seat, 0) + pitch(-angle) * Vec3(side, above - settings_.length, before);
  }

  Pose pose(std::size_t sample) const {
    const double t = static_cast<double>(sample) / settings_.fps, angle = angles_[sample], size = figure_.size();
    const double sits = smooth(k_hop, k_seated, t);
    const double pump = smooth(k_seated - 0.2, k_seated + 0.4, t) * pumping(sample);
    const Vec3 standing = Vec3(0, figure_.standing(), on_swing(angles_[0], 0, 0, 0).z() + 0.36);
    const double above = figure_.hip_above_seat() + figure_.hip_drop();
    Pose out;
    out.hips = standing + sits * (on_swing(angle, 0, above, -0.005) - standing);
    out.hips.y() += 0.25 * sits * (1 - sits);

    out.tilt = sits * angle;
    out.lean = sits * 8 * k_rad + 12 * k_rad * pump;
    const double thigh = out.tilt + sits * 90 * k_rad + 4 * k_rad * pump;
    const double knee = sits * (75 * k_rad + 80 * k_rad * (1 - sits)) - 48 * k_rad * pump;
    for (const std::size_t side : {0, 1}) {
      out.thigh[side] = thigh;
      out.shin[side] = thigh - knee;
      out.foot[side] = thigh - knee - 20 * k_rad * sits;
      out.grip[side] = on_swing(angle, side == 0 ? k_rope_side : -k_rope_side, 0.43 * size, 0);
    }
    return out;
  }

  SwingSettings settings_;
  Figure figure_;
  std::vector<double> angles_;
};

}  // namespace

std::string child_bvh(const SwingSettings& settings) {
  return Child(settings).text();
}

}  // namespace ft::sets
