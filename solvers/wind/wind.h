// The air of a shot: fields, which add up.
#pragma once

#include <memory>
#include <vector>

#include "solvers/wind/wind_field.h"

namespace ft::inline solvers {

/// What stands in the wind: how much of it gets to a place, from which direction it comes.
class Shelter {
 public:
  virtual ~Shelter() = default;
  /// As it stands at a time; see WindField::at_time.
  class Now {
   public:
    virtual ~Now() = default;
    /// Share of a wind of this velocity that gets to a place: 1 all, 0 none.
    virtual double open(const Vec3& place, const Vec3& velocity) const = 0;
  };
  virtual std::unique_ptr<Now> at_time(double time) const = 0;
};

class Wind {
 public:
  void add(std::unique_ptr<WindField> field) { fields_.push_back(std::move(field)); }
  void add(std::shared_ptr<const Shelter> shelter) { shelters_.push_back(std::move(shelter)); }

  std::span<const std::unique_ptr<WindField>> fields() const { return fields_; }
  /// No field, or none that blows.
  bool is_still() const { return fastest() == 0; }
  /// The air is nowhere and never faster [m/s].
  double fastest() const;
  /// All fields at a time [s from the shot's first frame]. Must not outlive the wind. Never null.
  std::unique_ptr<AirNow> at_time(double time) const;

 private:
  std::vector<std::unique_ptr<WindField>> fields_;
  std::vector<std::shared_ptr<const Shelter>> shelters_;
};

/// The same everywhere, for ever [m/s].
std::shared_ptr<const Wind> steady_wind(const Vec3& velocity);

}  // namespace ft::inline solvers
