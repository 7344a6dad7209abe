#include "baker/plan/preroll_speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ft::inline baker {
namespace {

constexpr double k_hasty = 2;      ///< m/s
constexpr double k_by_shot = 3;    ///< times as fast as the shot
constexpr double k_at_ease = 2.5;  ///< m/s, of the pre-roll that is advised

/// Of any vertex between two frames [m/s].
double fastest(const Shot& shot, const Trajectory& trajectory, int first, int last) {
  std::vector<Vec3> before(static_cast<std::size_t>(trajectory.surface().vertex_count())), now(before.size());
  trajectory.sample((first - shot.first_frame) / shot.fps, before);
  double out = 0;
  for (int frame = first + 1; frame <= last; ++frame) {
    trajectory.sample((frame - shot.first_frame) / shot.fps, now);
    for (std::size_t v = 0; v < now.size(); ++v) out = std::max(out, (now[v] - before[v]).norm() * shot.fps);
    now.swap(before);
  }
  return out;
}

}  // namespace

std::optional<std::string> hasty_preroll(const Shot& shot, const std::string& primary, const Trajectory& trajectory) {
  if (shot.preroll < 2) return std::nullopt;
  const double there = fastest(shot, trajectory, shot.first_frame - shot.preroll, shot.first_frame);
  const double here = fastest(shot, trajectory, shot.first_frame, shot.last_frame);
  if (there < k_hasty || there < k_by_shot * here) return std::nullopt;
  return fmt::format(
      "primary \"{}\": goes from its bind pose to the first frame at up to {:.2g} m/s, where the shot has {:.2g} m/s "
      "at "
      "most: frames of the pre-roll may cost many times those of the shot; preroll = {} is calmer",
      primary, there, here, static_cast<int>(std::ceil(shot.preroll * there / k_at_ease)));
}

}  // namespace ft::inline baker
