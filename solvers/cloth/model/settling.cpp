#include "solvers/cloth/model/settling.h"

#include <algorithm>
#include <string_view>

#include "baker/core/check.h"

namespace ft::inline solvers {
namespace {

/// Cloth that starts through cloth has so long to get out of it before the pre-roll, and no longer than this after the
/// last crossing that was less [s].
constexpr double k_longest_settling = 2, k_patience = 1;
/// The block of a state that has settled: frames, crossings that are left, the fewest, and after how many frames those
/// were reached first.
constexpr std::string_view k_settling = "settling";

}  // namespace

Settling settling_of(const ClothSetup& setup, const State& state) {
  const std::vector<double>* known = state.find(k_settling);
  Settling out;
  if (known) out.frames = static_cast<int>((*known)[0]), out.crossings = static_cast<int>((*known)[1]);
  if (setup.preroll_frames == 0 || state.frame != setup.first_frame - setup.preroll_frames) return out;
  const std::vector<double>* tangled = state.find("tangled");
  CHECK(tangled);
  out.goes_on = std::any_of(tangled->begin(), tangled->end(), [](double is) { return is != 0; }) &&
                out.frames < k_longest_settling * setup.fps &&
                (!known || out.frames - (*known)[3] < k_patience * setup.fps);
  return out;
}

void count_settled(int crossings, State& state) {
  const std::vector<double>* known = state.find(k_settling);
  const double frames = known ? (*known)[0] + 1 : 1, left = crossings;
  const bool fewer = !known || left < (*known)[2];
  state.set(k_settling, {frames, left, fewer ? left : (*known)[2], fewer ? frames : (*known)[3]});
}

}  // namespace ft::inline solvers
