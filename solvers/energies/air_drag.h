// Air drag of cloth panels, per area, relative to the wind:
//   f = -rho/2 A (Cn |vn| vn + Ct |vt| vt),   vn, vt: the velocity against the wind, normal and tangential to the panel
// A third of each panel moves with each of its corners. The normal and the speed are those expected at the end of the
// step, the law is linearised about the velocity at its start: |v| v = 2 |v0| v - |v0| v0, so that the potential is
// quadratic, stable for any wind and step, and second order in time. Vacuum (density or coefficients 0) is exactly
// nothing.
#pragma once

#include <array>
#include <vector>

#include "baker/core/mesh.h"
#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/energy.h"

namespace ft {

struct AirSettings {
  double density = 1.225;    ///< kg/m3; 0 vacuum, 1.225 air at sea level
  Vec3 wind = Vec3::Zero();  ///< m/s
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
  /// A panel's damping matrix [kg/s] per corner and the force that its linearised law has at zero velocity [N] per
  /// corner. In float: the law itself is known to a few per cent.
  struct Panel {
    std::array<float, 6> damping{};  ///< xx, yy, zz, xy, yz, zx
    std::array<float, 3> force{};
    Panel& operator+=(const Panel& other);
    Mat3 damping_matrix() const;
    Vec3 force_vector() const;
  };
  Panel panel(std::size_t triangle, const StepContext& context) const;

  AirSettings air_;
  std::vector<Triangle> triangles_;
  std::vector<float> normal_factor_, tangential_factor_;  ///< rho/2 C A / 3 of each triangle [kg/m]
  Adjacency around_;                                      ///< vertex -> triangles
  bool still_ = true;                                     ///< vacuum
  // Of the step, per vertex: U = rate_time/2 v.D v - rate_time f.v with v = (x - reference) / rate_time.
  Vec3 velocity(std::span<const Vec3> x, std::size_t vertex) const;
  std::vector<Panel> panels_, vertices_;
  std::span<const Vec3> x_t0_, x_tm1_;
  double a_ = 1, b_ = 0;  ///< reference = a x_t0 - b x_tm1; b = 0: x_t0
  double rate_time_ = 1;
};

}  // namespace ft
