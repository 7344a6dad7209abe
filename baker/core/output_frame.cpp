#include "baker/core/output_frame.h"

#include <algorithm>
#include <cmath>

namespace ft {

bool all_finite(const FrameData& frame) {
  const auto vectors = [](const std::vector<Vec3f>& all) {
    return std::all_of(all.begin(), all.end(), [](const Vec3f& v) { return v.allFinite(); });
  };
  return vectors(frame.positions) && vectors(frame.velocities) && vectors(frame.angular_velocities) &&
         vectors(frame.scales) &&
         std::all_of(frame.widths.begin(), frame.widths.end(), [](float w) { return std::isfinite(w); }) &&
         std::all_of(frame.orientations.begin(), frame.orientations.end(),
                     [](const Eigen::Quaternionf& q) { return q.coeffs().allFinite(); });
}

}  // namespace ft
