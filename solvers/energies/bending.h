// Out-of-plane elasticity of cloth: dihedral hinges with rest angles (Grinspun et al. 2003, "Discrete shells"), with damping of the
// angle's rate.
//   U = sum k/2 ((theta - rest)^2 + d (theta - theta_ref)^2),   k = B |e|^2 / (A1 + A2),   d as in membrane.h
// Hessian: Gauss-Newton, (1 + d) k grad theta grad theta^T, positive semidefinite by construction and blind to rigid rotation.
// For garments, whose rest shape is not flat. Where k comes from: cloth_topology.cpp.
// Caution: theta jumps at +-pi; contact keeps cloth from folding through itself.
#pragma once

#include <vector>

#include "solvers/energies/block_positions.h"
#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/element_schedule.h"
#include "solvers/energies/energy.h"

namespace ft {

class Bending final : public Energy {
 public:
  explicit Bending(const ClothTopology& topology);
  std::string_view name() const override { return "bending"; }
  std::vector<std::array<int, 4>> stencils() const override { return stencils_; }
  void begin_step(const StepContext& context) override;
  double value(std::span<const Vec3> x) const override;
  void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const override;
  void add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const override;

  /// k_lanes hinges; all zero in padding.
  struct Group {
    int vertex[4][k_lanes];
    double stiffness[k_lanes];     ///< N m
    double rest_angle[k_lanes];    ///< rad
    double damping_time[k_lanes];  ///< s
    double floor2[k_lanes];        ///< see hinge_angles() [m4]
    double reference[k_lanes];     ///< theta_ref of the step [rad]
  };

 private:
  std::vector<std::array<int, 4>> stencils_;
  ElementSchedule schedule_;
  std::vector<Group> groups_;
  double inverse_rate_time_ = 0;  ///< 1/s; 0: no damping
  mutable BlockPositions<4> positions_;
};

}  // namespace ft
