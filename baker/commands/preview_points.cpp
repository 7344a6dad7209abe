#include "baker/commands/preview_points.h"

#include <algorithm>
#include <cmath>

#include "baker/commands/base64.h"

namespace ft::inline baker {
namespace {

constexpr float k_usual_width = 0.004f;  ///< of points without widths [m]

}  // namespace

Result<Json> preview_points(const ManifestSystem& system, const CacheTrack& track, int frames) {
  Box box;
  float widest = 0;
  std::size_t most = 0;
  FrameData frame;
  for (int f = 0; f < frames; ++f) {
    if (const Status read = track.read(f, frame); !read) return read.error();
    for (const Vec3f& p : frame.positions) box.include(p.cast<double>());
    for (const float w : frame.widths) widest = std::max(widest, w);
    most = std::max(most, frame.positions.size());
  }
  if (box.empty()) box.include(Vec3::Zero());
  if (!(widest > 0)) widest = k_usual_width;
  const Vec3 low = box.lo, step = box.size() / 65535.0;
  std::vector<std::uint16_t> positions, widths;
  std::vector<std::uint32_t> counts;
  for (int f = 0; f < frames; ++f) {
    if (const Status read = track.read(f, frame); !read) return read.error();
    counts.push_back(static_cast<std::uint32_t>(frame.positions.size()));
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      for (int k = 0; k < 3; ++k)
        positions.push_back(step[k] > 0
                                ? static_cast<std::uint16_t>(std::lround((frame.positions[i][k] - low[k]) / step[k]))
                                : std::uint16_t{0});
      const float width = frame.widths.empty() ? widest : frame.widths[i];
      widths.push_back(static_cast<std::uint16_t>(std::lround(65535 * width / widest)));
    }
  }
  Json out{{"name", system.name}, {"role", system.role}, {"vertices", most}};
  out["low"] = {low[0], low[1], low[2]};
  out["step"] = {step[0], step[1], step[2]};
  out["positions"] = base64_of(positions);
  out["points"] = {{"counts", base64_of(counts)}, {"widths", base64_of(widths)}, {"widest", widest}};
  return out;
}

}  // namespace ft::inline baker
