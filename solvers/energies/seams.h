// Sewing: a vertex of one panel is drawn to a point on another's edge and kept there.
//   U = integral of f(e), e = |x_v - (1 - t) x_a - t x_b| - L,   f = min(k e, limit), 0 where e < 0
// L shrinks evenly from the distance at the start to nothing while the seam closes; from then on it is a spring of no
// length with a far higher limit. The limit keeps a panel that is caught behind an arm from being torn. For panels that
// are cut from a pattern. Hessian: with the secant f / e along the spring, which is the true one as long as the limit
// is not reached and above it beyond. Caution: the two sides must not feel each other's contact, see
// collision/sewn_pairs.h.
#pragma once

#include <vector>

#include "solvers/energies/block_positions.h"
#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/energy.h"

namespace ft {

/// Constants of a seam per metre of its length, so that they do not depend on the mesh.
struct SeamSettings {
  double stiffness = 5e5;  ///< N/m2. 1e5 opens 0.3 mm under the pull of a tight waist (30 N/m), 1e6 is dear to solve
  double pull = 30;        ///< N/m while it closes: as much as stretches cotton by some per cent
  double hold = 2000;      ///< N/m afterwards: lockstitched seams break at 2000..6000
};

class Seams final : public Energy {
 public:
  explicit Seams(const ClothTopology& topology);
  std::string_view name() const override { return "seams"; }
  std::vector<std::array<int, 4>> stencils() const override { return stencils_; }
  void begin_step(const StepContext& context) override;
  double value(std::span<const Vec3> x) const override;
  void add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const override;
  void add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const override;

 private:
  struct Target {
    double length = 0, limit = 0;  ///< m, N
  };
  std::vector<SeamPoint> points_;
  std::vector<std::array<int, 4>> stencils_;
  std::vector<int> slots_;
  std::vector<Target> targets_;  ///< of the step
  mutable BlockPositions<3> positions_;
};

}  // namespace ft
