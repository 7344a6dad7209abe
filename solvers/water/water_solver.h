// Water in a scene: bodies go through it as their trajectories say, what floats goes where the water takes it, and its
// surface and its droplets are cached. The water itself is a WaterCore (water_core.h).
//
// The surface is a mesh of constant topology: a vertex at each corner of the grid's cells, as high as the wet cells
// around it; where all of them are dry, a little below the ground, so that the ground hides it. Its scalars are means
// over all cells around, wet or dry.
//
// Where something has dived in, the mesh goes down into the cavity (cavity_skin.h), and its vertices leave their places
// on the grid.
//
// In the pre-roll the water stands still: bodies come out of their bind poses then, and nobody is to see their waves.
#pragma once

#include "baker/core/output_shape.h"
#include "baker/core/trajectory.h"
#include "solvers/base/has_scalars.h"
#include "solvers/base/moves_primaries.h"
#include "solvers/base/solver.h"
#include "solvers/water/water_core.h"

namespace ft::inline solvers {

/// A body that goes through the water as it likes.
struct WaterVisitor {
  std::string name;
  std::shared_ptr<const Trajectory> trajectory;
};

/// A primary that floats: the core's body of the same index.
struct WaterFloat {
  std::string name;
  std::vector<Vec3> positions;  ///< of its surface about its centre of mass, body axes [m]
};

struct WaterScene {
  std::string name = "water";
  int first_frame = 1;
  double fps = 24;
  int preroll_frames = 0;
  bool droplets = true;  ///< as a second system; without it nothing flies
  std::vector<WaterVisitor> visitors;
  std::vector<WaterFloat> floats;
};

struct DrawnIn;

/// The surface of still water as its mesh; level: m.
Mesh water_mesh(const std::string& name, const WaterGrid& grid, double level);
/// The droplets' caches: points with velocities and widths, any number of them.
SystemShape droplets_shape(const std::string& name);

/// A report's `own`: water_volume [m3] and water_error, by which all that the ledger knows has changed since the start
/// [1]; water_airborne [m3], water_outflow [m3], water_droplets, water_steps, water_energy [J], water_fastest [m/s].
class WaterSolver final : public Solver, public MovesPrimaries, public HasScalars {
 public:
  WaterSolver(WaterScene scene, std::unique_ptr<WaterCore> core);

  int system_count() const override { return scene_.droplets ? 2 : 1; }
  const SystemShape* system_shape(int system) const override { return system == 1 ? &droplets_ : nullptr; }
  const Mesh& system_mesh(int) const override { return mesh_; }
  void system_positions(const State& state, int system, std::span<Vec3> positions) const override;
  std::span<const std::string> scalar_names(int system) const override {
    return system == 0 ? core_->scalar_names() : std::span<const std::string>();
  }
  void system_scalars(const State& state, int system, std::vector<std::vector<float>>& values) const override;
  /// Of the water at the vertices: along, and up as it comes along the slope that it is on. With how fast the surface
  /// rises at the vertices this is the water's whole velocity, and moves the surface to where it is a moment later.
  /// Zero where it is dry.
  void surface_flow(const State& state, int system, std::span<Vec3> velocities) const override;
  void system_frame(const State& state, int system, FrameData& frame) const override;
  std::span<const Triangle> collider_triangles() const override { return {}; }
  void collider_positions(const State&, std::vector<Vec3>& positions) const override { positions.clear(); }
  State initial_state() const override;
  FrameReport advance_frame(State& state) override;

  bool moves(std::string_view primary) const override;
  void moved_positions(const State& state, std::string_view primary, std::span<Vec3> positions) const override;

  const WaterCore& core() const { return *core_; }

 private:
  /// Of the surface where no cavity is open.
  void level_positions(const State& state, std::span<Vec3> positions) const;
  std::vector<DrawnIn> drawn_in(const State& state) const;
  void say(std::string text, FrameReport& report) const;
  void add_forces(const WaterReport& done, std::span<const std::vector<Vec3>> to, FrameReport& report) const;

  WaterScene scene_;
  std::unique_ptr<WaterCore> core_;
  Mesh mesh_;
  SystemShape droplets_;
  double volume_ = 0;  ///< of all water at the start [m3]
};

}  // namespace ft::inline solvers
