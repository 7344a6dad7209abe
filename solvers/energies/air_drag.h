// Air drag of cloth panels, per area, relative to the wind:
//   f = -rho/2 A (Cn |vn| vn + Ct |vt| vt),   vn, vt: the velocity against the wind, normal and tangential to the panel
// As options of a fabric: the lift of a thin plate, rho/2 A C_l |vt| vn, at angles below 15 degrees, beyond which the
// flow leaves it; and the air that a light cloth takes along, a layer that resists being accelerated along the
// normal, in which the wind itself counts as steady. A third of each panel moves with each of its corners. The normal
// and the speed are those expected at the end of the step, the law is linearised about the velocity at its start: |v| v
// = 2 |v0| v - |v0| v0, so that the potential is quadratic, stable for any wind and step, and second order in time.
// Vacuum (density or coefficients 0) is exactly nothing.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/energy.h"
#include "solvers/energies/triangle_slots.h"
#include "solvers/wind/wind.h"

namespace ft::inline solvers {

struct AirSettings {
  double density = 1.225;              ///< kg/m3; 0 vacuum, 1.225 air at sea level
  std::shared_ptr<const Wind> wind{};  ///< null: the air stands still
};

class AirDrag final : public Energy {
 public:
  AirDrag(const ClothTopology& topology, const AirSettings& air);
  std::string_view name() const override { return "air_drag"; }
  bool is_internal() const override { return false; }
  std::vector<std::array<int, 4>> stencils() const override { return {}; }
  void begin_step(const StepContext& context) override;
  double value(std::span<const Vec3> x) const override;
  void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const override;
  void add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const override;

 private:
  /// Damping matrix [kg/s] and the force that the linearised law has at zero velocity [N], of a panel for each of its
  /// corners, or of all around a vertex. In float: the law itself is known to a few per cent.
  struct Drag {
    std::array<float, 6> damping{};  ///< xx, yy, zz, xy, yz, zx
    std::array<float, 3> force{};
    Drag& operator+=(const Drag& other);
    Mat3f damping_matrix() const;
    Vec3 damping_times(const Vec3& v) const;
    Vec3 force_vector() const;
  };
  /// Per area, as a fabric has it: rho/2 C / 3 [kg/m3]; mass: of the air that goes along, over three [kg/m2].
  struct Factors {
    double normal = 0, tangential = 0, lift = 0, mass = 0;
  };
  Drag panel(const Triangle& corners, double area, const Factors& factors, const StepContext& context,
             const AirNow* wind) const;
  Vec3 velocity(std::span<const Vec3> x, std::size_t vertex) const;

  AirSettings air_;
  std::vector<Factors> factors_;  ///< of the pieces
  bool still_ = true;             ///< vacuum; then there is nothing of what follows
  std::shared_ptr<const TriangleSlots> slots_;
  std::vector<float> area_;  ///< of the panel in each slot, at rest [m2]
  // Of the step, per vertex: U = rate_time/2 v.D v - rate_time f.v with v = (x - reference) / rate_time.
  std::vector<Drag> vertices_;
  std::span<const Vec3> x_t0_, x_tm1_;
  double a_ = 1, b_ = 0;  ///< reference = a x_t0 - b x_tm1; b = 0: x_t0
  double rate_time_ = 1;
};

}  // namespace ft::inline solvers
