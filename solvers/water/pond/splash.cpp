#include "solvers/water/pond/splash.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "solvers/water/pond/skin_volume.h"

namespace ft::inline solvers {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr std::uint64_t k_splash_system = 0x73706c61;  ///< of random keys
constexpr double k_air_density = 1.2, k_air_drag = 0.47;
constexpr int k_flight_steps = 8;        ///< of a frame
constexpr int k_most_of_throw = 4000;    ///< droplets of one ring and frame
constexpr double k_least_volume = 2e-9;  ///< thrown, less waits for more [m3]
constexpr double k_foam_width = 3;       ///< of what a droplet covers, in its diameters

double diameter(double volume) {
  return std::cbrt(6 * volume / k_pi);
}

}  // namespace

void add_foam(const PondModes& m, double x, double z, double area, std::span<double> foam) {
  const double p = std::clamp(x / m.cell_x() - 0.5, 0.0, m.nx - 1.0),
               q = std::clamp(z / m.cell_z() - 0.5, 0.0, m.nz - 1.0);
  const int i = std::min(static_cast<int>(p), m.nx - 2), j = std::min(static_cast<int>(q), m.nz - 2);
  const double u = p - i, v = q - j, cover = area / (m.cell_x() * m.cell_z());
  double* at = foam.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(m.stride) + i;
  at[0] += (1 - u) * (1 - v) * cover, at[1] += u * (1 - v) * cover;
  at[m.stride] += (1 - u) * v * cover, at[m.stride + 1] += u * v * cover;
}

double throw_water(const Throw& t, const SplashSettings& settings, const SplashWater& water,
                   std::span<const double> heights, const PondModes& modes, std::vector<Droplet>& droplets,
                   double& next_id, ThrownWays& ways, VolumeLayers& volumes) {
  const double mean_square = (t.slow * t.slow + t.slow * t.fast + t.fast * t.fast) / 3;
  if (!(mean_square > 0) || !(t.energy > 0)) return 0;
  const double volume = 2 * t.energy / (mean_square * water.density);
  if (volume < k_least_volume) return 0;
  const double usual = k_pi / 6 * std::pow(settings.droplet_diameter, 3);
  const auto room = std::max<std::int64_t>(0, settings.most_droplets - static_cast<std::int64_t>(droplets.size()));
  const int most = static_cast<int>(std::min<std::int64_t>(room, k_most_of_throw));
  if (most == 0) return 0;
  const int count = std::clamp(static_cast<int>(volume / usual + 0.5), 1, most);
  // Sizes spread as 0.4 to 1.6 of the mean volume; the sum is exact.
  std::vector<double> sizes;
  double sum = 0;
  const auto key = [&](int i) {
    return RandomKey{water.seed, k_splash_system + t.source, static_cast<std::uint64_t>(water.frame),
                     static_cast<std::uint64_t>(i)};
  };
  for (int i = 0; i < count; ++i) {
    sizes.push_back(0.4 + 1.2 * random_uniform(key(i), 0));
    sum += sizes.back();
  }
  double thrown = 0;
  for (int i = 0; i < count; ++i) {
    const RandomKey k = key(i);
    const double around = 2 * k_pi * (i + random_uniform(k, 1)) / count;
    const double steep = t.steep_least + (t.steep_most - t.steep_least) * random_uniform(k, 2);
    const double speed = t.slow + (t.fast - t.slow) * random_uniform(k, 3);
    const Vec3 out(std::cos(around), 0, std::sin(around));
    Droplet d;
    d.id = static_cast<std::uint64_t>(next_id);
    next_id += 1;
    d.volume = volume * sizes[at(i)] / sum;
    d.place = Vec3(t.x, 0, t.z) + t.radius * out;
    d.place.x() = std::clamp(d.place.x(), 0.0, modes.length_x),
    d.place.z() = std::clamp(d.place.z(), 0.0, modes.length_z);
    d.place.y() = height_at(modes, heights, d.place.x(), d.place.z());
    d.velocity = speed * (std::cos(steep) * out + std::sin(steep) * Vec3::UnitY());
    volumes.add(d.place.x(), d.place.z(), std::max(0.5 * t.radius, 0.15), -d.volume);
    thrown += d.volume;
    // It has left at some time of the frame.
    const double rest = water.frame_time * random_uniform(k, 4);
    ways.starts.push_back(d.place);
    ways.since.push_back(1 - rest / water.frame_time);
    d.place += rest * d.velocity - Vec3(0, 0.5 * water.gravity * rest * rest, 0);
    d.velocity.y() -= water.gravity * rest;
    droplets.push_back(d);
  }
  return thrown;
}

void PondMet::set_step(double share0, double share1) {
  const auto poses_at = [&](double share) {
    std::vector<RigidPose> out;
    for (std::size_t b = 0; b < from.size(); ++b)
      out.push_back(
          {(1 - share) * from[b].position + share * to[b].position, from[b].rotation.slerp(share, to[b].rotation)});
    return out;
  };
  bodies.set_step(share0, share1, poses_at(share0), poses_at(share1));
}

Landed fly(const PondModes& modes, const SplashWater& water, std::span<const double> heights, PondMet& met,
           std::vector<Droplet>& droplets, VolumeLayers& volumes, VolumeLayers& pushes, std::span<double> foam) {
  const double h = water.frame_time / k_flight_steps;
  std::vector<char> state(droplets.size(), 0);  // 1 landed, 2 gone
  std::vector<Droplet> flying = droplets;
  std::vector<std::size_t> who(droplets.size());
  std::iota(who.begin(), who.end(), std::size_t{0});
  std::vector<Vec3> starts;
  for (int n = 0; n < k_flight_steps && !flying.empty(); ++n) {
    starts.resize(flying.size());
    parallel_for(flying.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Droplet& d = flying[i];
        const double drag = 0.75 * k_air_drag * k_air_density / (water.density * diameter(d.volume));
        d.velocity.y() -= h * water.gravity;
        d.velocity /= 1 + h * drag * d.velocity.norm();
        starts[i] = d.place;
        d.place += h * d.velocity;
      }
    });
    met.set_step(static_cast<double>(n) / k_flight_steps, static_cast<double>(n + 1) / k_flight_steps);
    met.bodies.stop(flying, starts, h);
    parallel_for(flying.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3& p = flying[i].place;
        const bool inside = p.x() >= 0 && p.z() >= 0 && p.x() <= modes.length_x && p.z() <= modes.length_z;
        if (flying[i].velocity.y() <= 0 && p.y() <= height_at(modes, heights, p.x(), p.z()))
          state[who[i]] = inside ? 1 : 2;
      }
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < flying.size(); ++i) {
      droplets[who[i]] = flying[i];
      if (state[who[i]] == 0) flying[kept] = flying[i], who[kept++] = who[i];
    }
    flying.resize(kept), who.resize(kept);
  }
  Landed out;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < droplets.size(); ++i) {
    const Droplet& d = droplets[i];
    if (state[i] == 1) {
      volumes.add(d.place.x(), d.place.z(), 0, d.volume);
      pushes.add(d.place.x(), d.place.z(), 0, d.volume * d.velocity.y());
      const double wide = k_foam_width * diameter(d.volume);
      add_foam(modes, d.place.x(), d.place.z(), 0.25 * k_pi * wide * wide, foam);
      ++out.count;
    } else if (state[i] == 2) {
      out.gone += d.volume;
    } else {
      droplets[kept++] = d;
    }
  }
  droplets.resize(kept);
  return out;
}

}  // namespace ft::inline solvers
