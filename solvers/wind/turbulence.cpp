#include "solvers/wind/turbulence.h"

#include <cmath>
#include <numbers>

#include "baker/core/random.h"

namespace ft::inline solvers {
namespace {

using std::numbers::pi;

constexpr int k_waves = 24;
constexpr double k_finest = 8;           ///< the largest wave number by the smallest
constexpr double k_turnover_rate = 0.5;  ///< of a wave, by its wave number times the turnover speed

Vec3 direction(const RandomKey& key, std::uint64_t draw) {
  const double up = 2 * random_uniform(key, draw) - 1, around = 2 * pi * random_uniform(key, draw + 1);
  const double level = std::sqrt(1 - up * up);
  return {level * std::cos(around), up, level * std::sin(around)};
}

/// Of length 1, across k.
Vec3 across(const Vec3& k, const RandomKey& key, std::uint64_t draw) {
  Vec3 out = k.cross(direction(key, draw));
  while (out.norm() < 1e-3 * k.norm()) out = k.cross(direction(key, ++draw));
  return out.normalized();
}

class Waves final : public AirNow {
 public:
  Waves(std::vector<TurbulentWaves::Wave> waves, double intensity) : waves_(std::move(waves)), intensity_(intensity) {}
  Vec3 velocity(const Vec3& place) const override { return intensity_ * TurbulentWaves::velocity(waves_, place); }

 private:
  std::vector<TurbulentWaves::Wave> waves_;
  double intensity_;
};

}  // namespace

TurbulentWaves::TurbulentWaves(double length, double turnover, const Vec3& drift, std::uint64_t seed) {
  double squares = 0;
  for (int i = 0; i < k_waves; ++i) {
    const RandomKey key{seed, 2, 0, static_cast<std::uint64_t>(i)};
    const double number = 2 * pi / length * std::pow(k_finest, (i + 0.5) / k_waves);
    // Of E(k) ~ k^-5/3, in bands as wide as k.
    const double height = std::pow(number, -1.0 / 3);
    Wave wave;
    wave.k = number * direction(key, 0);
    wave.cosine = height * across(wave.k, key, 10);
    wave.sine = height * across(wave.k, key, 50);
    wave.phase = 2 * pi * random_uniform(key, 100);
    squares += height * height;
    waves_.push_back(wave);
    rates_.push_back(k_turnover_rate * number * turnover - wave.k.dot(drift));
  }
  // A wave's velocity squared is on the average a half of each amplitude squared, and that over three components.
  const double scale = std::sqrt(3 / squares);
  for (Wave& wave : waves_) {
    wave.cosine *= scale;
    wave.sine *= scale;
  }
}

std::vector<TurbulentWaves::Wave> TurbulentWaves::at_time(double time) const {
  std::vector<Wave> out = waves_;
  for (std::size_t i = 0; i < out.size(); ++i) out[i].phase += rates_[i] * time;
  return out;
}

Vec3 TurbulentWaves::velocity(std::span<const Wave> waves, const Vec3& place) {
  Vec3 sum = Vec3::Zero();
  for (const Wave& wave : waves) {
    const double phase = wave.k.dot(place) + wave.phase;
    sum += std::cos(phase) * wave.cosine + std::sin(phase) * wave.sine;
  }
  return sum;
}

double TurbulentWaves::most() const {
  double sum = 0;
  for (const Wave& wave : waves_) sum += std::hypot(wave.cosine.norm(), wave.sine.norm());
  return sum;
}

Turbulence::Turbulence(WindFieldSpec given)
    : WindField(std::move(given)), waves_(spec().length, spec().intensity, spec().velocity, spec().seed) {}

Result<std::unique_ptr<WindField>> Turbulence::make(const WindFieldSpec& spec) {
  if (!(spec.length > 0)) return usage_error("length must be above 0", spec.name);
  if (!(spec.intensity > 0))
    return usage_error("turbulence without an intensity moves nothing", spec.name, "intensity = 1");
  return std::unique_ptr<WindField>(std::make_unique<Turbulence>(spec));
}

std::unique_ptr<AirNow> Turbulence::at_time(double time) const {
  return std::make_unique<Waves>(waves_.at_time(spec().clock + time), spec().intensity);
}

}  // namespace ft::inline solvers
