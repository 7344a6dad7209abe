// See splash.h. The rate at a rim, whose share of the water under a foot does not depend on the cells' size:
//   dV/dt = share (1 - threshold^2/u^2) u depth dx
#include "solvers/water/shallow/splash.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ft::inline solvers {
namespace {

constexpr double k_pi = std::numbers::pi;
/// A throw leaves at least so much of a cell's water [1].
constexpr double k_left = 0.5;
/// Elevations of throws [rad], 25 to 70 degrees, and how far they scatter to both sides.
constexpr double k_lowest = 25 * k_pi / 180, k_highest = 70 * k_pi / 180, k_scatter = 0.5;
constexpr double k_covered = 0.5;
/// A droplet that lands on a covered cell runs off to a free one, at most so many cells away.
constexpr int k_run_off = 64;
constexpr double k_wet = 1e-5;  ///< less is no level [m]

/// Of a column that a body presses down, the nearest one that is free, along one of the axes; itself where there is
/// none.
std::size_t nearest_free(const Flow& f, int& i, int& k) {
  for (int r = 1; r <= k_run_off; ++r)
    for (const auto& [di, dk] : {std::pair{r, 0}, {-r, 0}, {0, r}, {0, -r}}) {
      const int x = i + di, z = k + dk;
      if (x < 0 || x >= f.nx || z < 0 || z >= f.nz || f.lift[f.of(x, z)] != 0) continue;
      i = x, k = z;
      return f.of(i, k);
    }
  return f.of(i, k);
}

}  // namespace

void throw_droplets(Flow& f, const NearWater& near, const ShallowSplash& splash, const SplashTime& time, double world_x,
                    double world_z, double pressure_speed, double dt, std::size_t most, std::uint64_t& next_id,
                    std::vector<Droplet>& droplets) {
  const double area = f.cell * f.cell;
  for (const NearWater::Cell& cell : near.cells()) {
    if (!(cell.covered >= k_covered)) continue;
    for (int side = 0; side < 4; ++side) {
      const bool along_x = side < 2, high = side % 2 == 1;
      const int i = cell.i + (along_x ? (high ? 1 : -1) : 0), k = cell.k + (along_x ? 0 : (high ? 1 : -1));
      const int other = near.index(i, k);
      if (other < 0 || near.cells()[at(other)].covered >= k_covered) continue;
      if (i < 0 || k < 0 || i >= f.nx || k >= f.nz) continue;
      const std::size_t c = f.of(i, k), face = high ? c : cell.c;
      const double out = (high ? 1 : -1) * (along_x ? f.u1 : f.w1)[face];
      if (!(out > splash.threshold)) continue;
      const double speed = std::min(out, pressure_speed);
      const double depth = std::abs((along_x ? f.qx1 : f.qz1)[face]) / out;
      const double wanted =
          splash.share * (1 - splash.threshold * splash.threshold / (out * out)) * out * depth * f.cell * dt;
      // Where the water goes: this face's speed outwards, and that along it beside the rim.
      const std::vector<double>& across = along_x ? f.w1 : f.u1;
      const std::size_t next = along_x ? f.row : 1;
      const double sideways = 0.5 * (across[cell.c] + across[cell.c + next]);
      const double heading =
          along_x ? std::atan2(sideways, (high ? 1 : -1) * out) : std::atan2((high ? 1 : -1) * out, sideways);
      const std::uint64_t where =
          (static_cast<std::uint64_t>(f.x0 + cell.i) * 0x10000u + static_cast<std::uint64_t>(f.z0 + cell.k)) * 4 +
          static_cast<std::uint64_t>(side);
      const RandomKey key{time.seed, 0x5b1a, time.frame, mix64(time.step) ^ where};
      double left = wanted;
      std::uint64_t draw = 0;
      for (int n = 0; n < 64 && left > 0 && droplets.size() < most; ++n) {
        const double room = f.h1[c] * (1 - k_left) * area;
        const double size = splash.smallest + (splash.largest - splash.smallest) * random_uniform(key, draw++);
        const double volume = std::min(k_pi / 6 * size * size * size, room);
        if (!(volume > 1e-12)) break;
        // The last one flies with the chance that makes the mean right.
        const double chance = left / volume;
        left -= volume;
        if (random_uniform(key, draw++) >= chance) break;
        const double pace = speed * (0.5 + 0.5 * random_uniform(key, draw++));
        const double rise = k_lowest + (k_highest - k_lowest) * random_uniform(key, draw++);
        const double turn = heading + k_scatter * (2 * random_uniform(key, draw++) - 1);
        Droplet d;
        d.id = next_id++;
        d.volume = volume;
        d.place = Vec3(world_x + (i + random_uniform(key, draw)) * f.cell, f.bed[c] + f.h1[c],
                       world_z + (k + random_uniform(key, draw + 1)) * f.cell);
        draw += 2;
        d.velocity = pace * Vec3(std::cos(rise) * std::cos(turn), std::sin(rise), std::cos(rise) * std::sin(turn));
        f.h1[c] -= volume / area;
        droplets.push_back(d);
      }
    }
  }
}

double land(std::vector<Droplet>& droplets, Flow& f, double world_x, double world_z, double level_outside) {
  const double area = f.cell * f.cell;
  double outside = 0;
  std::size_t kept = 0;
  for (std::size_t n = 0; n < droplets.size(); ++n) {
    const Droplet& d = droplets[n];
    const double x = std::floor((d.place.x() - world_x) / f.cell), z = std::floor((d.place.z() - world_z) / f.cell);
    if (!(x >= 0 && z >= 0 && x < f.nx && z < f.nz)) {
      if (d.place.y() < level_outside)
        outside += d.volume;
      else
        droplets[kept++] = d;
      continue;
    }
    int i = static_cast<int>(x), k = static_cast<int>(z);
    std::size_t c = f.of(i, k);
    double top = f.bed[c] + f.h[c];
    if (d.velocity.y() <= 0 && f.lift[c] != 0) {
      c = nearest_free(f, i, k);
      // On a body under water: the water stands over it as high as beside it.
      if (f.lift[c] == 0 && f.h[c] > k_wet) top = std::max(top, f.bed[c] + f.h[c]);
    }
    if (d.place.y() > top || d.velocity.y() > 0) {
      droplets[kept++] = d;
      continue;
    }
    f.h[c] += d.volume / area;
    // Half its momentum to either face of the column.
    const auto push = [&](std::vector<double>& v, std::size_t face, std::size_t back, bool wall, double speed) {
      const double water = 0.5 * (f.h[face - back] + f.h[face]) * area;
      if (!wall && water > 0) v[face] += 0.5 * d.volume / water * (speed - v[face]);
    };
    push(f.u, c, 1, i == 0, d.velocity.x());
    push(f.u, c + 1, 1, i + 1 == f.nx, d.velocity.x());
    push(f.w, c, f.row, k == 0, d.velocity.z());
    push(f.w, c + f.row, f.row, k + 1 == f.nz, d.velocity.z());
  }
  droplets.resize(kept);
  return outside;
}

}  // namespace ft::inline solvers
