// In-plane elasticity of cloth: constant-strain triangles, orthotropic St. Venant-Kirchhoff, with strain-rate damping.
//   U = sum A/2 (E.CE + d (E - E_ref).C(E - E_ref)),   d = damping time / rate time of the integrator
//       + sum A k (t(E11 - L1) + t(E22 - L2)),   t'' rising from 0 to 1 over a strain of 1 %: limits of a weave
//       + sum A j t(|2 E12| - L3),   the same over a shear of 0.05: its yarns jam
// E is the Green strain (E11, E22, 2 E12) in weft/warp axes, E_ref what the integrator's rate formula subtracts from E,
// to seven digits: a body that moves rigidly does not feel the first term change, and of damping no more than that.
// Hessian: Gauss-Newton plus the geometric term with the positive part of the 2x2 stress (closed form, no 9x9
// eigenproblem). For cloth, mats, sails. Caution: StVK softens under strong compression; cloth buckles out of the plane
// long before.
#pragma once

#include <memory>
#include <vector>

#include "solvers/energies/block_positions.h"
#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/energy.h"
#include "solvers/energies/triangle_slots.h"

namespace ft::inline solvers {

/// Plane-stress stiffness in weft (1) and warp (2) axes: C11, C22, C12, C33 [N/m]. Positive definite for poisson in [0,
/// 1).
std::array<double, 4> membrane_stiffness(const Fabric& fabric);

class Membrane final : public Energy {
 public:
  explicit Membrane(const ClothTopology& topology);
  std::string_view name() const override { return "membrane"; }
  std::vector<std::array<int, 4>> stencils() const override;
  void begin_step(const StepContext& context) override;
  double value(std::span<const Vec3> x) const override;
  void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const override;
  void add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const override;
  void add_derivatives(std::span<const Vec3> x, std::span<Vec3> gradient, BlockMatrix& hessian) const override;

  /// Per area, as a fabric has it.
  struct Material {
    double stiffness[4] = {};  ///< C11, C22, C12, C33 [N/m]
    double damping_time = 0;   ///< s
    /// Of E11 and E22, beyond which yarns are straight, and of |2 E12|, beyond which they jam [1].
    double limit[3] = {};
    double limit_stiffness = 0;  ///< of straight yarns [N/m]
    double jam_stiffness = 0;    ///< of jammed yarns against shear [N/m]
  };
  /// k_lanes triangles; all zero in padding.
  struct Group {
    double rest_inverse[4][k_lanes];  ///< 1/m
    double area[k_lanes];             ///< at rest, times the factor of what varies over the garment [m2]
  };
  using Vertices = GroupIndices<3>::Group;
  struct Reference {
    float strain[3][k_lanes];  ///< E_ref
  };

 private:
  struct Stressed;
  void measure(std::size_t group, std::span<const Vec3> x, Stressed& out) const;
  void add_group_gradient(std::size_t group, const Stressed& stressed, std::span<Vec3> gradient) const;
  void add_group_hessian(std::size_t group, const Stressed& stressed, BlockMatrix& hessian) const;
  void find_places(const BlockPattern& pattern) const;

  std::shared_ptr<const TriangleSlots> slots_;
  std::vector<Group> groups_;
  std::vector<Material> materials_;  ///< of the pieces
  // Of the step.
  std::vector<Reference> reference_;
  double inverse_rate_time_ = 0;  ///< 1/s; 0: no damping
  mutable BlockPositions<3> positions_;
};

}  // namespace ft::inline solvers
