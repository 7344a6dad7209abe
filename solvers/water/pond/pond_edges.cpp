#include "solvers/water/pond/pond_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/parallel.h"
#include "baker/core/random.h"

namespace ft::inline solvers {
namespace {

/// Rate of the rim at the wall, over the frequency of waves twice as long as it is wide. Tuned on what comes back of
/// packets in water of depth 5 m on a rim of 5 m: of 1, 2.5, 5, 10 m 0.01, 0.1, 0.6, 7 % of the amplitude.
constexpr double k_rim_rate = 6;
constexpr std::uint64_t k_ruffle_system = 0x72756666;  ///< of random keys
constexpr double k_ruffle_memory = 4;                  ///< s in which a wave of the ruffle is forgotten
constexpr double k_ruffle_longest = 1.2;               ///< m

}  // namespace

std::vector<double> rim_keeps(const PondModes& m, double width, double frame_time) {
  std::vector<double> out(m.size(), 1.0);
  const double rate = k_rim_rate * std::sqrt(m.gravity / width * std::tanh(m.depth / width)) / std::numbers::pi;
  for (int j = 0; j < m.nz; ++j)
    for (int i = 0; i < m.nx; ++i) {
      const double x = (i + 0.5) * m.cell_x(), z = (j + 0.5) * m.cell_z();
      const double from_wall = std::min(std::min(x, m.length_x - x), std::min(z, m.length_z - z));
      const double s = std::clamp(1 - from_wall / width, 0.0, 1.0);
      out[static_cast<std::size_t>(j) * static_cast<std::size_t>(m.stride) + static_cast<std::size_t>(i)] =
          std::exp(-rate * frame_time * s * s);
    }
  return out;
}

double absorb_at_rim(const PondModes& m, std::span<const double> keeps, std::span<double> eta,
                     std::span<double> potential) {
  m.transform.to_values(eta);
  m.transform.to_values(potential);
  const auto stride = static_cast<std::size_t>(m.stride), columns = static_cast<std::size_t>(m.nx);
  const double lost = parallel_sum(static_cast<std::size_t>(m.nz), 16, 0.0, [&](std::size_t b, std::size_t e) {
    double sum = 0;
    for (std::size_t j = b; j < e; ++j)
      for (std::size_t i = j * stride; i < j * stride + columns; ++i) {
        const double less = (1 - keeps[i]) * eta[i];
        sum += less;
        eta[i] -= less;
        potential[i] *= keeps[i];
      }
    return sum;
  });
  m.transform.to_waves(eta);
  m.transform.to_waves(potential);
  return lost * m.cell_x() * m.cell_z();
}

void ruffle(const PondModes& m, double wind_x, double wind_z, std::uint64_t seed, int frame, double frame_time,
            std::span<double> potential) {
  const double speed = std::hypot(wind_x, wind_z);
  if (speed == 0) return;
  const double shortest = std::numbers::pi / (1.5 * std::max(m.cell_x(), m.cell_z()));
  const double longest = 2 * std::numbers::pi / k_ruffle_longest;
  // Slopes of short waves grow with the wind (Cox and Munk 1954: mean square 0.003 + 0.005 U); a part of them is here.
  const double mean_square_slope = 0.2 * (0.003 + 0.005 * speed) * std::min(1.0, speed / 2);
  const auto weight = [&](std::size_t n, std::size_t i, std::size_t j) {
    const double k = m.k[n];
    if (k < longest || k > shortest) return 0.0;
    const double along = std::abs(m.kx[i] * wind_x + m.kz[j] * wind_z),
                 across = std::abs(m.kx[i] * wind_x - m.kz[j] * wind_z);
    const double c = std::max(along, across) / (k * speed);
    return c * c / (k * k);  // slopes evenly over octaves
  };
  const auto stride = static_cast<std::size_t>(m.stride), rows = static_cast<std::size_t>(m.nz);
  const double sum = parallel_sum(rows, 16, 0.0, [&](std::size_t b, std::size_t e) {
    double part = 0;
    for (std::size_t j = b; j < e; ++j)
      for (std::size_t i = 0; i < static_cast<std::size_t>(m.nx); ++i) part += weight(j * stride + i, i, j);
    return part;
  });
  if (sum == 0) return;
  const double kept = std::exp(-2 * frame_time / k_ruffle_memory), pushed = std::sqrt(1 - kept * kept);
  parallel_for(rows, 16, [&](std::size_t b, std::size_t e) {
    for (std::size_t j = b; j < e; ++j)
      for (std::size_t i = 0; i < static_cast<std::size_t>(m.nx); ++i) {
        const std::size_t n = j * stride + i;
        const double w = weight(n, i, j);
        if (w == 0) continue;
        // The potential of a wave whose mean square slope is that share; a wave's is a quarter of (k eta)^2 here.
        const double eta = 2 * std::sqrt(mean_square_slope * w / sum) / m.k[n];
        const double size = eta * std::sqrt(m.gravity / m.rise[n]);
        const RandomKey key{seed, k_ruffle_system, static_cast<std::uint64_t>(frame), n};
        // Three even draws are near enough to a bell; their variance is a quarter.
        const double draw = 2 * (random_uniform(key, 0) + random_uniform(key, 1) + random_uniform(key, 2) - 1.5);
        potential[n] = kept * potential[n] + pushed * size * draw;
      }
  });
}

}  // namespace ft::inline solvers
