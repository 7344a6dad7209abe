#include "solvers/wind/log_profile.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

constexpr double k_surface_layer = 100;  ///< how thick that of the atmosphere is, about [m]

class Sheared final : public AirNow {
 public:
  Sheared(std::unique_ptr<AirNow> air, const LogProfile& profile) : air_(std::move(air)), profile_(profile) {}
  Vec3 velocity(const Vec3& place) const override { return profile_.share(place.y()) * air_->velocity(place); }

 private:
  std::unique_ptr<AirNow> air_;
  LogProfile profile_;
};

}  // namespace

double LogProfile::top() const {
  return std::max(k_surface_layer, reference_height);
}

double LogProfile::share(double y) const {
  const double height = std::clamp(y - ground, 0.0, top());
  return std::log1p(height / roughness_length) / std::log1p(reference_height / roughness_length);
}

ProfiledWind::ProfiledWind(std::unique_ptr<WindField> uniform, const LogProfile& profile)
    : WindField(uniform->spec()), uniform_(std::move(uniform)), profile_(profile) {}

std::unique_ptr<AirNow> ProfiledWind::at_time(double time) const {
  return std::make_unique<Sheared>(uniform_->at_time(time), profile_);
}

double ProfiledWind::fastest() const {
  return profile_.share(profile_.ground + profile_.top()) * uniform_->fastest();
}

bool ProfiledWind::is_divergence_free() const {
  return uniform_->is_divergence_free() && spec().velocity.y() == 0;
}

}  // namespace ft::inline solvers
