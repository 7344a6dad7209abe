// A volume that damps what is in it (a net, hay, a curtain), at rest in the world:
//   F = -w (C v + c2 |v| v),   torque = -w c_r omega      (O'Brien, Zordan & Hodgins 2000, section 3.3)
// w is the share of the body's volume that is inside, by soft edges from 0 to 1. C = c, or c along each axis.
#pragma once

#include <optional>
#include <vector>

#include "collision/check/checked_surface.h"
#include "solvers/standins/standin.h"

namespace ft::inline solvers {

/// Reads shape and its measures, soft_edge, damping, damping_axes, damping_quadratic, damping_spin.
class DampingVolume : public StandIn {
 public:
  static Result<std::unique_ptr<StandIn>> make(const StandInSpec& spec);
  bool is_dissipative() const override { return true; }
  bool reaches(const BodyState& body, double margin) const override;

 protected:
  explicit DampingVolume(const StandInSpec& spec);
  /// What is wrong with shape and damping; may_be_undamped: something else acts in it.
  static std::optional<Error> check(const StandInSpec& spec, bool may_be_undamped);
  StandInForce law(const BodyState& body) const override;
  /// Share of the body's volume that counts as inside.
  double share(const BodyState& body) const;

 private:
  /// How far inside [m]; 0 or less outside, where it need not be the distance.
  double depth(const Vec3& place) const;

  std::vector<Vec3> positions_;  ///< of the mesh, in the shape's axes
  std::vector<Triangle> triangles_;
  std::optional<CheckedSurface> surface_;
};

}  // namespace ft::inline solvers
