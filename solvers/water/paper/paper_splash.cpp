// See paper_splash.h. Of a column that rises with v, a step throws
//   dV = share (v - threshold) cell^2 dt
// in droplets that leave with v, drawn by lot: the last one flies with the chance that makes the mean right. A column's
// rise is no energy of the model, so that droplets have to be paid for by the pipes.
#include "solvers/water/paper/paper_splash.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ft::inline solvers {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_smallest_share = 0.1, k_largest_share = 0.4;  ///< of a cell, where the setup says no sizes [1]
/// A throw leaves at least so much of a column [1].
constexpr double k_left = 0.5;
/// Of the energy in a column's pipes, that a step's droplets may take [1].
constexpr double k_paid = 0.5;
constexpr double k_no_droplet = 1e-12;  ///< m3
constexpr int k_most_of_cell = 64;

/// Of the free columns of three by three, so that ripples of the grid's own throw nothing [m/s].
double mean_rise(const PipeWater& w, const UnderBodies& under, std::size_t c) {
  const int i = static_cast<int>(c % at(w.nx)), k = static_cast<int>(c / at(w.nx));
  double sum = 0;
  int count = 0;
  for (int z = std::max(0, k - 1); z <= std::min(w.nz - 1, k + 1); ++z)
    for (int x = std::max(0, i - 1); x <= std::min(w.nx - 1, i + 1); ++x) {
      if (under.of(w.of(x, z)) >= 0) continue;
      sum += w.rise[w.of(x, z)];
      ++count;
    }
  return sum / count;
}

}  // namespace

int throw_droplets(PipeWater& w, const UnderBodies& under, const PaperSplash& splash, const PaperThrow& when, double dt,
                   const Vec2& origin, std::uint64_t& next_id, std::vector<Droplet>& droplets) {
  const std::size_t before = droplets.size();
  const double area = w.cell * w.cell;
  const double smallest = splash.smallest > 0 ? splash.smallest : k_smallest_share * w.cell;
  const double largest = splash.largest > 0 ? splash.largest : k_largest_share * w.cell;
  for (std::size_t c = 0; c < w.depth.size(); ++c) {
    if (under.of(c) >= 0 || !(w.rise[c] > splash.threshold)) continue;  // in a body depth is no height
    const double rise = mean_rise(w, under, c);
    if (!(rise > splash.threshold)) continue;
    const RandomKey key{when.seed, 0x9a9e, when.frame, mix64(when.step) ^ c};
    const double speed = std::min(rise, splash.fastest);
    const Vec2 along = w.velocity(c);
    double left = std::min(splash.share * (rise - splash.threshold) * dt, (1 - k_left) * w.depth[c]) * area;
    const double energy = w.kinetic_of(under, c);
    double taken = 0;
    std::uint64_t draw = 0;
    for (int n = 0; n < k_most_of_cell && droplets.size() < at(splash.most_droplets); ++n) {
      const double size = smallest + (largest - smallest) * random_uniform(key, draw++);
      const double volume = std::min(k_pi / 6 * size * size * size, (1 - k_left) * w.depth[c] * area);
      if (!(volume > k_no_droplet)) break;
      const double chance = left / volume;
      left -= volume;
      if (random_uniform(key, draw++) >= chance) break;
      const double lean = splash.spread * std::sqrt(random_uniform(key, draw++));
      const double turn = 2 * k_pi * random_uniform(key, draw++);
      const double i = static_cast<double>(c % at(w.nx)) + random_uniform(key, draw++);
      const double k = static_cast<double>(c / at(w.nx)) + random_uniform(key, draw++);
      Droplet d;
      d.id = next_id;
      d.volume = volume;
      d.place = Vec3(origin.x() + w.cell * i, w.bed[c] + w.depth[c], origin.y() + w.cell * k);
      d.velocity = speed * Vec3(std::sin(lean) * std::cos(turn), std::cos(lean), std::sin(lean) * std::sin(turn));
      const double carried = std::min(1.0, speed / std::max(along.norm(), 1e-12));
      d.velocity += carried * Vec3(along.x(), 0, along.y());
      const double cost = 0.5 * volume * d.velocity.squaredNorm();
      if (taken + cost > k_paid * energy) break;
      taken += cost;
      w.depth[c] -= volume / area;
      droplets.push_back(d);
      ++next_id;
    }
    if (taken > 0) w.slow(c, taken / energy);
  }
  return static_cast<int>(droplets.size() - before);
}

double land(std::vector<Droplet>& droplets, PipeWater& w, const Vec2& origin, double level_outside) {
  const double area = w.cell * w.cell;
  double outside = 0;
  std::size_t kept = 0;
  for (const Droplet& d : droplets) {
    const double x = std::floor((d.place.x() - origin.x()) / w.cell),
                 z = std::floor((d.place.z() - origin.y()) / w.cell);
    const bool inside = x >= 0 && z >= 0 && x < w.nx && z < w.nz;
    if (!inside) {
      if (d.place.y() < level_outside)
        outside += d.volume;
      else
        droplets[kept++] = d;
      continue;
    }
    const std::size_t c = w.of(static_cast<int>(x), static_cast<int>(z));
    if (d.velocity.y() > 0 || d.place.y() > w.head[c]) {
      droplets[kept++] = d;
      continue;
    }
    w.depth[c] += d.volume / area;
  }
  droplets.resize(kept);
  return outside;
}

}  // namespace ft::inline solvers
