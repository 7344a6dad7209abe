#include "baker/core/output_frame.h"

#include <algorithm>
#include <cmath>

namespace ft {

bool all_finite(const FrameData& frame) {
  const auto vectors = [](const std::vector<Vec3f>& all) {
    return std::all_of(all.begin(), all.end(), [](const Vec3f& v) { return v.allFinite(); });
  };
  const auto numbers = [](const std::vector<float>& all) {
    return std::all_of(all.begin(), all.end(), [](float x) { return std::isfinite(x); });
  };
  return vectors(frame.positions) && vectors(frame.velocities) && vectors(frame.angular_velocities) &&
         vectors(frame.scales) && numbers(frame.widths) &&
         std::all_of(frame.orientations.begin(), frame.orientations.end(),
                     [](const Eigen::Quaternionf& q) { return q.coeffs().allFinite(); }) &&
         std::all_of(frame.scalars.begin(), frame.scalars.end(), numbers);
}

}  // namespace ft
