// Who sits down on make_set's chair.
#include <algorithm>
#include <cmath>

#include "samples/tools/chair.h"
#include "samples/tools/figure.h"

namespace ft::sets {
namespace {

/// Feet stay where they are; thigh and shin make the triangle over them, the knee before it.
void plant(const Figure& figure, Pose& pose) {
  const Vec3 joint = pose.hips + pitch(-pose.tilt - 0.5 * pose.lean) * Vec3(0, -figure.hip_drop(), 0);
  const Vec3 way = Vec3(0, figure.ankle(), 0) - joint;
  const double a = figure.thigh(), b = figure.shin();
  const double far = std::clamp(way.norm(), std::abs(a - b), a + b);
  const double leg = std::atan2(way.z(), -way.y());  // from straight down, forwards
  const double at_hip = std::acos(std::clamp((a * a + far * far - b * b) / (2 * a * far), -1.0, 1.0));
  const double at_knee = std::acos(std::clamp((a * a + b * b - far * far) / (2 * a * b), -1.0, 1.0));
  for (const std::size_t side : {0, 1}) {
    pose.thigh[side] = leg + at_hip;
    pose.shin[side] = leg + at_hip - (std::numbers::pi - at_knee);
  }
}

}  // namespace

std::string sitter_bvh(const SitterSettings& settings, const ChairSettings& chair) {
  const Figure figure(settings.height);
  const double size = figure.size();
  const Vec3 standing(0, figure.standing(), 0);
  const Vec3 sitting(0, chair.seat + figure.hip_above_seat() + figure.hip_drop(), -0.95 * figure.thigh());
  std::vector<Pose> poses;
  for (int sample = 0; sample / settings.fps <= settings.seconds; ++sample) {
    const double t = sample / settings.fps, back = smooth(0.3, 1.6, t), down = smooth(0.3, 1.9, t);
    Pose pose;
    pose.elbows = Vec3(0.7, -1, -0.3);
    pose.hips = standing + Vec3(0, down * (sitting.y() - standing.y()), back * sitting.z());
    pose.lean = -40 * k_rad * smooth(0.2, 1.1, t) * (1 - smooth(1.3, 2.3, t));
    plant(figure, pose);
    // From before the belly to the lap, above cloth that lies on the thighs.
    const double lap = smooth(0.8, 2.2, t);
    const Vec3 first = Vec3(0.09, 0.74, 0.21) * size,
               last = sitting + Vec3(0.075 * size, -figure.hip_drop() + 0.094 * size, 0.17 * size);
    for (const std::size_t side : {0, 1}) {
      pose.grip[side] = first + lap * (last - first);
      if (side == 1) pose.grip[side].x() *= -1;
    }
    poses.push_back(pose);
  }
  return figure.bvh(poses, settings.fps);
}

}  // namespace ft::sets
