// See wind.h. Shelters are not asked yet.
#include "solvers/wind/wind.h"

#include <algorithm>

namespace ft::inline solvers {
namespace {

class SumNow final : public AirNow {
 public:
  void add(double gain, std::unique_ptr<AirNow> now) { parts_.push_back({gain, std::move(now)}); }
  Vec3 velocity(const Vec3& place) const override {
    Vec3 sum = Vec3::Zero();
    for (const auto& [gain, now] : parts_) sum += gain * now->velocity(place);
    return sum;
  }

 private:
  std::vector<std::pair<double, std::unique_ptr<AirNow>>> parts_;
};

class SteadyField final : public WindField {
 public:
  using WindField::WindField;
  std::unique_ptr<AirNow> at(double) const override { return std::make_unique<Now>(spec().velocity); }
  double fastest() const override { return spec().velocity.norm(); }
  bool is_divergence_free() const override { return true; }

 private:
  class Now final : public AirNow {
   public:
    explicit Now(const Vec3& v) : v_(v) {}
    Vec3 velocity(const Vec3&) const override { return v_; }

   private:
    Vec3 v_;
  };
};

}  // namespace

double WindField::strength(double time) const {
  const double rise = spec_.fade > 0 ? (time - spec_.from) / spec_.fade : (time >= spec_.from ? 1.0 : 0.0);
  const double fall =
      spec_.fade > 0 ? (spec_.until + spec_.fade - time) / spec_.fade : (time <= spec_.until ? 1.0 : 0.0);
  return spec_.gain * std::clamp(std::min(rise, fall), 0.0, 1.0);
}

double Wind::fastest() const {
  double sum = 0;
  for (const auto& field : fields_) sum += std::abs(field->spec().gain) * field->fastest();
  return sum;
}

std::unique_ptr<AirNow> Wind::at(double time) const {
  auto out = std::make_unique<SumNow>();
  for (const auto& field : fields_)
    if (const double gain = field->strength(time); gain != 0) out->add(gain, field->at(time));
  return out;
}

std::shared_ptr<const Wind> steady_wind(const Vec3& velocity) {
  auto wind = std::make_shared<Wind>();
  WindFieldSpec spec;
  spec.kind = "uniform";
  spec.velocity = velocity;
  wind->add(std::make_unique<SteadyField>(spec));
  return wind;
}

}  // namespace ft::inline solvers
