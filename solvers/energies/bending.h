// Out-of-plane elasticity of cloth. The angles theta of all inner edges, less those of the rest shape, are coupled
// triangle by triangle, because three of them make the curvature of one (cloth_topology_bending.cpp):
//   U = 1/2 phi.K.phi + 1/2 rho.K.rho,  phi = theta - rest,  rho = sqrt(d) (theta - theta_ref),  d: as in membrane.h
// K holds up to five numbers per edge and never changes. Hessian: Gauss-Newton with the diagonal of K, sum (1 + d) K_ii
// grad theta_i grad theta_i^T: positive semidefinite, blind to rigid rotation, and of the plain hinge pattern. Dropping
// the coupling keeps the matrix a third smaller and its assembly several times cheaper; the true Hessian stays below
// twice this one, so that a Newton step never overshoots (the contract test measures the ratio). For garments, whose
// rest shape is not flat, with rigidities of warp and weft in N m. Caution: theta jumps at +-pi; contact keeps cloth
// from folding through itself.
#pragma once

#include <cstdint>
#include <vector>

#include "baker/core/hash.h"
#include "solvers/energies/block_positions.h"
#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/element_schedule.h"
#include "solvers/energies/energy.h"
#include "solvers/energies/group_indices.h"

namespace ft::inline solvers {

class Bending final : public Energy {
 public:
  explicit Bending(const ClothTopology& topology);
  std::string_view name() const override { return "bending"; }
  std::vector<std::array<int, 4>> stencils() const override;
  void begin_step(const StepContext& context) override;
  double value(std::span<const Vec3> x) const override;
  void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const override;
  void add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const override;
  void add_derivatives(std::span<const Vec3> x, std::span<Vec3> gradient, BlockMatrix& hessian) const override;

  static constexpr int k_couplings = 5;

  /// k_lanes hinges; no coupling in padding.
  struct HingeGroup {
    float coupling[k_couplings][k_lanes];           ///< with itself, and with its neighbours [N m]
    float rest_angle[k_lanes];                      ///< rad
    std::uint16_t piece[k_lanes];                   ///< of the topology
    std::uint8_t floor2[k_lanes], floor3[k_lanes];  ///< exponents of what hinge_gradient_lanes() takes [m4]
  };
  using Vertices = GroupIndices<4>::Group;

 private:
  struct HingeShape;
  /// How far all hinges are from their rest angles; the same bits whenever it is worked out.
  struct Bends {
    Hash128 of;               ///< of the positions
    std::vector<double> phi;  ///< per hinge slot [rad]
  };
  void work_out(std::span<const Vec3> x, Bends& bends) const;
  void measure(std::span<const Vec3> x) const;
  double since_reference(std::size_t slot) const;
  void add_group_gradient(std::size_t group, const HingeShape& shape, std::span<Vec3> gradient) const;
  void add_group_hessian(std::size_t group, const HingeShape& shape, BlockMatrix& hessian) const;
  void find_places(const BlockPattern& pattern) const;

  ElementSchedule schedule_;
  GroupIndices<4> vertices_;
  GroupIndices<k_couplings - 1> neighbours_;  ///< slots of the other hinges of a row of K
  std::vector<HingeGroup> groups_;
  std::vector<double> damping_time_;  ///< of the pieces [s]
  // Of the step.
  bool damps_ = false;
  std::vector<double> root_;      ///< of the pieces: sqrt(d) [1]
  std::vector<float> reference_;  ///< per hinge slot: theta_ref, as Bends::phi, to seven digits [rad]
  mutable BlockPositions<4> positions_;
  // Of the last x that was measured: the next question is mostly about the same one, and the next step starts there.
  mutable Bends last_;
  mutable bool measured_ = false;       ///< in this step, what follows
  mutable std::vector<double> moment_;  ///< dU / d theta [N m]; gathering it anew while the matrix is filled is slow
  mutable double energy_ = 0;           ///< J
};

}  // namespace ft::inline solvers
