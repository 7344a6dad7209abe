// What the scenes of the conformance table are made of: rectangles of cloth, boxes to lie on, moving posts to pin to,
// and a solver with its state.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "baker/core/trajectory.h"
#include "solvers/cloth/cloth_solver.h"

namespace ft::inline solvers {

/// columns x rows cells, alternating diagonals; vertex (i, j) is i + (columns + 1) j, placed by s = i / columns, t = j
/// / rows.
Mesh rectangle_mesh(int columns, int rows, const std::function<Vec3(double s, double t)>& place);

/// Isotropic fabric [N/m, N m, kg/m2] without damping.
Fabric plain_fabric(double mass_per_area, double stretch, double bend, double poisson = 0);

/// Cloth alone in vacuum, solved accurately: no self-contact, tight tolerances, fixed substeps.
ClothSetup accurate_setup(Mesh mesh, const Fabric& fabric, double fps, int substeps);

/// Pins the vertices stiffly: stiffness [N/m3] per garment area. 1e8 gives by 0.1 um under 10 Pa.
void pin_stiffly(ClothSetup& setup, std::vector<int> vertices, double stiffness = 1e8);

/// A closed surface of axis-aligned boxes, each a part, moved by place(box, time, point).
struct BoxSpec {
  Vec3 lo, hi;
};
std::shared_ptr<const Trajectory> make_boxes(
    std::vector<BoxSpec> boxes, std::function<Vec3(std::size_t box, double time, const Vec3& point)> place);

/// A solver and its state.
class ClothRun {
 public:
  explicit ClothRun(ClothSetup setup);
  /// Velocities of all vertices at the start [m/s]; forgets the history, so that the first substep is implicit Euler.
  void set_velocity(const std::function<Vec3(const Vec3& place)>& velocity);
  FrameReport advance() { return solver_->advance_frame(state_); }
  void advance(int frames) {
    for (int f = 0; f < frames; ++f) advance();
  }
  std::vector<Vec3> positions() const;
  std::vector<Vec3> velocities() const;
  double time() const { return state_.time; }

 private:
  std::unique_ptr<Solver> solver_;
  State state_;
};

}  // namespace ft::inline solvers
