#include "solvers/wind/uniform_wind.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/random.h"

namespace ft::inline solvers {
namespace {

constexpr int k_waves = 16;
constexpr double k_slowest = 0.25, k_fastest = 4;  ///< of the waves, times 1 / gust_time
constexpr double k_heading = 0.3;                  ///< root mean square of the heading by that of the speed [rad]

class Everywhere final : public AirNow {
 public:
  explicit Everywhere(const Vec3& velocity) : velocity_(velocity) {}
  Vec3 velocity(const Vec3&) const override { return velocity_; }

 private:
  Vec3 velocity_;
};

}  // namespace

UniformWind::UniformWind(WindFieldSpec given) : WindField(std::move(given)) {
  if (spec().gusts == 0) return;
  for (int i = 0; i < k_waves; ++i) {
    const RandomKey key{spec().seed, 1, 0, static_cast<std::uint64_t>(i)};
    const double share = (i + random_uniform(key, 0)) / k_waves;
    Wave wave;
    wave.rate = 2 * std::numbers::pi / spec().gust_time * k_slowest * std::pow(k_fastest / k_slowest, share);
    for (std::uint64_t k = 0; k < 2; ++k) wave.phase[k] = 2 * std::numbers::pi * random_uniform(key, 1 + k);
    waves_.push_back(wave);
  }
}

Result<std::unique_ptr<WindField>> UniformWind::make(const WindFieldSpec& spec) {
  if (spec.velocity == Vec3::Zero())
    return usage_error("a uniform wind without a velocity has no direction", spec.name, "velocity = [5, 0, 0]");
  if (!(spec.gusts >= 0)) return usage_error("gusts must be 0 or more", spec.name);
  if (!(spec.gust_time > 0)) return usage_error("gust_time must be above 0", spec.name);
  return std::unique_ptr<WindField>(std::make_unique<UniformWind>(spec));
}

std::unique_ptr<AirNow> UniformWind::at_time(double time) const {
  if (waves_.empty()) return std::make_unique<Everywhere>(spec().velocity);
  double speed = 0, heading = 0;
  const double height = spec().gusts * std::sqrt(2.0 / k_waves);
  for (const Wave& wave : waves_) {
    speed += height * std::sin(wave.rate * (spec().clock + time) + wave.phase[0]);
    heading += k_heading * height * std::sin(wave.rate * (spec().clock + time) + wave.phase[1]);
  }
  const Eigen::AngleAxisd turned(heading, Vec3::UnitY());
  return std::make_unique<Everywhere>(std::max(0.0, 1 + speed) * (turned * spec().velocity));
}

double UniformWind::fastest() const {
  return (1 + spec().gusts * std::sqrt(2.0 * static_cast<double>(waves_.size()))) * spec().velocity.norm();
}

}  // namespace ft::inline solvers
