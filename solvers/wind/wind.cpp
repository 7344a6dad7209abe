#include "solvers/wind/wind.h"

#include <algorithm>

#include "baker/core/smooth_step.h"
#include "solvers/wind/uniform_wind.h"

namespace ft::inline solvers {
namespace {

class Sum final : public AirNow {
 public:
  struct Part {
    double strength = 1;
    std::unique_ptr<AirNow> air;
  };
  Sum(std::vector<Part> parts, std::vector<std::unique_ptr<Shelter::Now>> shelters)
      : parts_(std::move(parts)), shelters_(std::move(shelters)) {}

  Vec3 velocity(const Vec3& place) const override {
    Vec3 sum = Vec3::Zero();
    for (const Part& part : parts_) sum += part.strength * part.air->velocity(place);
    double open = 1;
    if (sum != Vec3::Zero())
      for (const auto& shelter : shelters_) open *= shelter->open(place, sum);
    return open * sum;
  }

 private:
  std::vector<Part> parts_;
  std::vector<std::unique_ptr<Shelter::Now>> shelters_;
};

}  // namespace

double WindField::strength(double time) const {
  if (spec_.fade <= 0) return time >= spec_.from && time <= spec_.until ? spec_.gain : 0;
  return spec_.gain *
         std::min(smooth_step((time - spec_.from) / spec_.fade), 1 - smooth_step((time - spec_.until) / spec_.fade));
}

double Wind::fastest() const {
  double sum = 0;
  for (const auto& field : fields_) sum += std::abs(field->spec().gain) * field->fastest();
  return sum;
}

std::unique_ptr<AirNow> Wind::at_time(double time) const {
  std::vector<Sum::Part> parts;
  for (const auto& field : fields_)
    if (const double strength = field->strength(time); strength != 0) parts.push_back({strength, field->at_time(time)});
  std::vector<std::unique_ptr<Shelter::Now>> shelters;
  if (!parts.empty())
    for (const auto& shelter : shelters_) shelters.push_back(shelter->at_time(time));
  return std::make_unique<Sum>(std::move(parts), std::move(shelters));
}

std::shared_ptr<const Wind> steady_wind(const Vec3& velocity) {
  auto wind = std::make_shared<Wind>();
  WindFieldSpec spec;
  spec.velocity = velocity;
  if (velocity != Vec3::Zero()) wind->add(std::make_unique<UniformWind>(std::move(spec)));
  return wind;
}

}  // namespace ft::inline solvers
