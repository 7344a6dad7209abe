// Two lower bounds of the time of impact, the later one taken at every iteration:
//   additive (Li et al. 2021): the features cannot approach faster than l = max|dx| of one + max|dx| of the other;
//   planes (ours): along the present normal every vertex moves linearly, so the time at which the first pair of
//     vertices has used up the room is known in closed form. It makes sliding contact cheap: additive steps alone need
//     motion / distance iterations there.
// Motion that all four vertices share is taken out first; it cannot change a distance.
#include "collision/geometry/ccd_li2021.h"

#include <algorithm>
#include <cmath>

namespace ft::inline collision {
namespace {

constexpr double k_step = 0.9;  // share of a bound that is used, as in the paper

/// Time in which the slab along g.normal shrinks to keep; 0 when it is narrower already, infinite when it never does.
double slab_time(int split, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& dx, const PairGeometry& g,
                 double keep) {
  double earliest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < split; ++i) {
    for (int j = split; j < 4; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const double room = g.normal.dot(x[a] - x[b]) - keep;
      const double approach = g.normal.dot(dx[b] - dx[a]);
      if (room <= 0) return 0;
      if (approach > 0) earliest = std::min(earliest, room / approach);
    }
  }
  return earliest;
}

double largest_norm(std::span<const Vec3> vectors) {
  double squared = 0;
  for (const Vec3& v : vectors) squared = std::max(squared, v.squaredNorm());
  return std::sqrt(squared);
}

}  // namespace

double ccd_time(PairKind kind, const std::array<Vec3, 4>& x_given, const std::array<Vec3, 4>& dx_given,
                const CcdSettings& settings) {
  const int split = first_feature_size(kind);
  const auto first_count = static_cast<std::size_t>(split);

  std::array<Vec3, 4> x0, dx;
  const Vec3 shared = 0.25 * (dx_given[0] + dx_given[1] + dx_given[2] + dx_given[3]);
  double extent = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    x0[i] = x_given[i] - x_given[0];
    dx[i] = dx_given[i] - shared;
    extent = std::max({extent, x0[i].cwiseAbs().maxCoeff(), dx_given[i].cwiseAbs().maxCoeff()});
  }
  const double rounding = 64 * std::numeric_limits<double>::epsilon() * extent;  // of any distance below [m]

  PairGeometry g = pair_geometry(kind, x0);
  if (g.distance <= rounding) return 0;
  const double speed =
      largest_norm(std::span(dx).first(first_count)) + largest_norm(std::span(dx).subspan(first_count));
  const double floor = g.distance > settings.floor + rounding ? settings.floor : 0.0;
  const double keep = std::max({floor, settings.gap_kept * g.distance, rounding});
  if (g.distance - keep >= speed) return 1;

  double t = 0;
  std::array<Vec3, 4> x = x0;
  for (int iteration = 0; iteration < settings.max_iterations; ++iteration) {
    const double room = g.distance - keep;
    if (room <= 0) break;
    // Both steps end with part of the room left, so the next distance is above keep again.
    double step = k_step * room / speed;
    step = std::max(step, k_step * slab_time(split, x, dx, g, keep));
    if (t + room / speed >= 1 || t + step >= 1) return 1;
    if (step < 1e-12) break;
    const double next = t + step;
    for (std::size_t i = 0; i < 4; ++i) x[i] = x0[i] + next * dx[i];
    const PairGeometry at_next = pair_geometry(kind, x);
    if (at_next.distance <= keep) break;
    t = next;
    g = at_next;
    if (g.distance <= keep + 0.1 * settings.gap_kept * keep) break;
  }
  return t;
}

}  // namespace ft::inline collision
