// One term of the incremental potential. Value, gradient and a positive semidefinite Hessian; the same bits for any
// thread count. Energies are listed in solvers/energies/registry.cpp; the contract test (gradient against differences,
// Hessian against differences of the gradient where it is exact, rigid motion invariance, rest state at zero force)
// runs over the list.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "baker/core/types.h"
#include "solvers/linear/block_matrix.h"

namespace ft::inline solvers {

/// What a step knows besides positions. Lagged quantities (damping, wind) use the start of the substep. The positions
/// and velocities must live as long as the step.
struct StepContext {
  double h = 1.0 / 240;        ///< substep [s]
  double beta_h = 1.0 / 240;   ///< of the rate below: h for implicit Euler, 2/3 h for BDF2 at constant h [s]
  std::span<const Vec3> x_t0;  ///< positions at the start of the substep [m]
  std::span<const Vec3> v_t0;  ///< velocities at the start of the substep [m/s]
  double time = 0;             ///< at the end of the substep [s]
  /// The rate of any q: (q - a q_t0 + b q_tm1) / beta_h, with a - b = 1. Without x_tm1 (empty): (q - q_t0) / h.
  std::span<const Vec3> x_tm1;  ///< positions one substep earlier [m]; may be empty
  double a = 1, b = 0;

  bool has_history() const { return !x_tm1.empty(); }
  /// Seconds between q and what the rate subtracts from it.
  double rate_time() const { return has_history() ? beta_h : h; }
};

class Energy {
 public:
  virtual ~Energy() = default;
  virtual std::string_view name() const = 0;
  /// Vertices coupled by each element; builds the pattern. -1 marks an unused slot.
  virtual std::vector<std::array<int, 4>> stencils() const = 0;
  /// Whether its forces on one garment add up to nothing, and their torques: elasticity and its damping.
  virtual bool is_internal() const { return true; }
  /// Forgets the last step, takes over this one's context.
  virtual void begin_step(const StepContext&) {}
  virtual double value(std::span<const Vec3> x) const = 0;                                 ///< J
  virtual void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const = 0;  ///< N
  virtual void add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const = 0;       ///< N/m
  /// Both at one x. Energies whose gradient and Hessian are made of the same things compute these once.
  virtual void add_derivatives(std::span<const Vec3> x, std::span<Vec3> gradient, BlockMatrix& hessian) const {
    add_gradient(x, gradient);
    add_hessian(x, hessian);
  }
};

}  // namespace ft::inline solvers
