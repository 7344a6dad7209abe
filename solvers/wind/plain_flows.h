// Flows with a centre. Source and sink: u = Q r / (4 pi |r|^3), and inside the core as r. Vortex about an axis (Lamb
// and Oseen): u = Gamma / (2 pi r) (1 - exp(-r^2 / R^2)) around it. Doublet: the flow about a sphere that moves with V,
// u = R^3 / (2 r^3) (3 (V . e) e - V), and V inside of it.
#pragma once

#include "solvers/wind/wind_field.h"

namespace ft::inline solvers {

class Source final : public WindField {
 public:
  using WindField::WindField;
  static Result<std::unique_ptr<WindField>> make(const WindFieldSpec& spec);
  static Result<std::unique_ptr<WindField>> make_sink(const WindFieldSpec& spec);
  std::unique_ptr<AirNow> at_time(double time) const override;
  double fastest() const override;
};

class Vortex final : public WindField {
 public:
  using WindField::WindField;
  static Result<std::unique_ptr<WindField>> make(const WindFieldSpec& spec);
  std::unique_ptr<AirNow> at_time(double time) const override;
  double fastest() const override;
  bool is_divergence_free() const override { return true; }
};

class Doublet final : public WindField {
 public:
  using WindField::WindField;
  static Result<std::unique_ptr<WindField>> make(const WindFieldSpec& spec);
  std::unique_ptr<AirNow> at_time(double time) const override;
  double fastest() const override { return spec().velocity.norm(); }
  /// But for the sphere's surface, along which the air slips.
  bool is_divergence_free() const override { return true; }
};

/// About a sphere at the origin that moves with `velocity`.
Vec3 doublet_velocity(const Vec3& from_centre, const Vec3& velocity, double radius);

}  // namespace ft::inline solvers
