#include "baker/plan/preroll_speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ft::inline baker {
namespace {

constexpr double k_by_shot = 3;    ///< times as fast as the shot
constexpr double k_at_ease = 2.5;  ///< m/s, of the pre-roll that is advised
constexpr int k_longest = 240;     ///< frames, of the pre-roll that is advised

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

std::string HastyPreroll::text(const std::string& primary, std::optional<int> taken) const {
  const std::string gets_there = fmt::format(
      "primary \"{}\": goes from its bind pose to the first frame at up to {:.2g} m/s, where the shot has {:.2g} m/s "
      "at "
      "most",
      primary, there, here);
  if (taken)
    return fmt::format(
        "{}, in the pre-roll of a shot that names none: it has {} frames instead (preroll under [shot] sets it)",
        gets_there, *taken);
  return fmt::format("{}: frames of the pre-roll may cost many times those of the shot; preroll = {} is calmer",
                     gets_there, calm);
}

std::optional<HastyPreroll> hasty_preroll(const Shot& shot, const Trajectory& trajectory) {
  if (shot.preroll < 2) return std::nullopt;
  HastyPreroll out;
  out.there = fastest(shot, trajectory, shot.first_frame - shot.preroll, shot.first_frame);
  out.here = fastest(shot, trajectory, shot.first_frame, shot.last_frame);
  if (out.there < k_by_shot * out.here) return std::nullopt;
  out.calm = std::min(k_longest, static_cast<int>(std::ceil(shot.preroll * out.there / k_at_ease)));
  if (out.calm <= shot.preroll) return std::nullopt;
  return out;
}

}  // namespace ft::inline baker
