#include "solvers/water/pond/cavity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ft::inline solvers {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_beta = 2;
constexpr double k_side_drag = 0.05;    ///< of the skin along its sides, on its section: feeds the crown
constexpr double k_close_step = 1e-3;   ///< s
constexpr double k_volume_depth = 0.6;  ///< a slice's air acts so many radii deeper than its middle

double volume(const CavitySlice& s) {
  return k_pi * std::max(s.square, 0.0) * std::abs(s.thickness);
}

}  // namespace

void cross_surface(const SkinUnderWater& from, const SkinUnderWater& to, double speed, double tail_speed, double time,
                   double body, const SplashSettings& settings, double density, Crossing& c,
                   std::vector<CavitySlice>& slices) {
  if (from.section == 0 && to.section == 0 && (to.bottom >= 0 || from.top < 0)) {
    // Out of the water or wholly under it: the next passage is a new one.
    if (to.bottom >= 0 && from.bottom >= 0)
      c = {.crown_energy = c.crown_energy,
           .crown_speed = c.crown_speed,
           .crown_x = c.crown_x,
           .crown_z = c.crown_z,
           .crown_radius = c.crown_radius};
  }
  const SkinUnderWater& wet = to.section > 0 ? to : from;
  const double radius = std::sqrt(wet.section / k_pi);
  if (wet.section > 0 && speed > settings.slowest) {
    // Added mass of a blunt nose, 4/3 rho r^3 (half of a disc's): its growth takes the energy that throws the crown.
    const double grown = std::max(0.0, std::pow(radius, 3) - std::pow(c.widest, 3));
    c.crown_energy += 0.5 * speed * speed * 4.0 / 3 * density * grown;
    c.crown_energy += 0.5 * density * k_side_drag * wet.section * speed * speed * speed * time;
    c.crown_speed = std::max(c.crown_speed, speed);
    c.crown_x = wet.section_x, c.crown_z = wet.section_z, c.crown_radius = std::max(c.crown_radius, radius);
  }
  if (wet.section > 0) {
    c.widest = std::max(c.widest, radius);
    if (speed > settings.cavity_speed && c.armed == 0) c.armed = 1, c.sealed = 0, c.cavity_energy = 0;
  }
  if (tail_speed < settings.cavity_speed && to.top < 0) c.armed = 0;
  if (c.armed == 0 || c.sealed != 0 || to.top >= 0) return;
  // Slices whose middle the tail has passed.
  const double step = settings.cavity_slice, start = std::max(0.0, -from.top), end = -to.top;
  for (auto n = static_cast<int>(std::max(0.0, std::ceil(start / step - 0.5))); (n + 0.5) * step <= end; ++n) {
    if ((n + 0.5) * step <= start && n > 0) continue;
    CavitySlice s;
    const double t = end > start ? std::clamp(((n + 0.5) * step - start) / (end - start), 0.0, 1.0) : 1;
    s.x = from.top_x + t * (to.top_x - from.top_x), s.z = from.top_z + t * (to.top_z - from.top_z);
    s.depth = (n + 0.5) * step;
    s.thickness = -step;  // it has pushed nothing yet
    s.acts_at = s.depth + k_volume_depth * c.widest;
    s.square = c.widest * c.widest;
    s.rate = 2 * c.widest * settings.cavity_opening * tail_speed;
    s.body = body;
    slices.push_back(s);
  }
}

void close_cavities(double time, double gravity, double density, const SplashSettings& settings,
                    std::span<Crossing> crossings, std::vector<CavitySlice>& slices, VolumeLayers& layers,
                    CavityEvents& events, std::span<double> foam, const PondModes& modes) {
  const int steps = static_cast<int>(std::ceil(time / k_close_step));
  const double h = time / steps;
  std::vector<double> energy(crossings.size(), 0), deepest(crossings.size(), 0);
  for (const CavitySlice& s : slices) {
    energy[static_cast<std::size_t>(s.body)] += density * gravity * s.depth * volume(s);
    deepest[static_cast<std::size_t>(s.body)] = std::max(deepest[static_cast<std::size_t>(s.body)], s.depth);
  }
  for (std::size_t b = 0; b < crossings.size(); ++b)
    crossings[b].cavity_energy = std::max(crossings[b].cavity_energy, energy[b]);
  std::size_t kept = 0;
  for (CavitySlice s : slices) {
    const double before = s.thickness < 0 ? 0 : volume(s);
    s.thickness = std::abs(s.thickness);
    for (int n = 0; n < steps && s.square > 0; ++n) {
      const double r = std::sqrt(s.square);
      s.rate -= h * 2 * gravity * std::max(s.depth, 1.5 * r) / k_beta;
      s.square += h * s.rate;
    }
    const double change = volume(s) - before;
    events.volume_change += change;
    layers.add(s.x, s.z, s.acts_at, change);
    if (s.square > 0) {
      slices[kept++] = s;
      continue;
    }
    Crossing& c = crossings[static_cast<std::size_t>(s.body)];
    add_foam(modes, s.x, s.z, k_pi * c.widest * c.widest, foam);
    if (c.sealed != 0) continue;
    c.sealed = 1;
    // The jet's tip goes as high as a part of the cavity was deep.
    Throw jet;
    jet.x = s.x, jet.z = s.z, jet.radius = 0.25 * c.widest;
    jet.fast = std::sqrt(2 * gravity * std::clamp(0.6 * deepest[static_cast<std::size_t>(s.body)], 0.2, 1.8));
    jet.slow = 0.3 * jet.fast;
    jet.steep_least = 1.48, jet.steep_most = 1.57;
    jet.energy = settings.jet_share * c.cavity_energy;
    events.jets.push_back(jet);
  }
  slices.resize(kept);
}

}  // namespace ft::inline solvers
