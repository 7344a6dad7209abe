// Pools and ponds: dispersive waves between walls or towards an open edge, bodies that float, dive and sink, skins that
// wade and dive, and what splashes. Waves are linear and exact in their speed (pond_modes.h); bodies are paired with
// them so that energy is kept (float_dynamics.h); water that is thrown is taken from the surface and given back where
// it lands (splash.h), and behind a diver stands a cavity of air (cavity.h).
//
// For water that is deep against what is in it: three times a body's radius or more; puddles and beaches are another
// solver's. Waves do not break. The bottom is even. World axes as water_body.h.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "baker/core/state.h"
#include "baker/core/wrench.h"
#include "solvers/water/pond/pond_setup.h"
#include "solvers/water/pond/pond_state.h"

namespace ft::inline solvers {

struct PondEnergy {
  double waves = 0, floats = 0;  ///< floats: kinetic with added mass, of height, and of displaced water [J]
  /// Since the start: what impacts, drag and contacts lost, the rim took, wind gave, droplets took along [J].
  double slam = 0, drag = 0, contact = 0, absorbed = 0, wind = 0, thrown = 0;
  double total() const { return waves + floats; }
};

/// What water does to a driven body in a frame; torques about the world's origin.
struct DrivenReport {
  Wrench mean, peak;     ///< peak: of the instant with the largest force
  double submerged = 0;  ///< at the end [m3]
  double speed = 0;      ///< of the middle of its volume, mean of the frame [m/s]
};

struct PondReport {
  int steps = 0;
  int thrown = 0, landed = 0, in_air = 0;  ///< droplets
  WaterLedger ledger;
  PondEnergy energy;
  std::vector<DrivenReport> driven;
  std::vector<Vec3> skin_pushes;   ///< by contact with floating bodies, impulses of the frame on each driven [N s]
  double lowest = 0, highest = 0;  ///< of the surface, above the level at rest [m]
  bool dry = false;                ///< a trough reached the floor: the shot asks for more than waves can be
  bool finite = true;
};

class PondSolver {
 public:
  /// Refuses, in one usage error, all faults of a setup.
  static Result<std::unique_ptr<PondSolver>> make(PondSetup setup);
  ~PondSolver();

  State initial_state() const;
  /// driven: the same bodies in the same order in every frame.
  PondReport advance_frame(State& state, double frame_time, std::span<const DrivenBody> driven) const;

  int nx() const { return setup_.nx; }
  int nz() const { return setup_.nz; }
  int float_count() const { return static_cast<int>(floats_.size()); }
  /// Above the world's origin, cell by cell, x fastest; nx * nz [m].
  void surface_heights(const State& state, std::span<double> out) const;
  /// Of water at the surface along x and z [m/s]; y is 0.
  void surface_flow(const State& state, std::span<Vec3> out) const;
  /// Share of the surface that patches of foam cover, 0 to 1: 1 - exp(-a) where they have an area of a times the
  /// surface's (Poisson).
  void foam(const State& state, std::span<double> out) const;
  std::vector<Droplet> droplets(const State& state) const;
  std::vector<RigidMotion> float_motions(const State& state) const;
  /// Behind each driven body that has any.
  std::vector<WaterCavity> cavities(const State& state) const;
  WaterLedger ledger(const State& state) const;
  PondEnergy energy(const State& state) const;
  const PondModes& modes() const { return modes_; }
  const PondSetup& setup() const { return setup_; }
  const FloatShape& float_shape_of(int body) const { return floats_[at(body)].shape; }

 private:
  struct Frame;
  explicit PondSolver(PondSetup setup);
  PondMemory memory(const State& state) const;
  WaterLedger ledger_of(const PondMemory& memory, double mean_height) const;
  /// Skins at the frame's start; how many slices they need.
  int begin_driven(Frame& frame, std::span<const DrivenBody> driven, double frame_time) const;
  /// What skins and cavities give to the surface in a slice, crowns and jets that it makes, forces on skins.
  void cross_driven(Frame& frame, std::span<const DrivenBody> driven, double frame_time, int slice, int slices) const;
  void throw_and_land(Frame& frame, std::span<const DrivenBody> driven, std::vector<RigidPose> floats_from,
                      double frame_time) const;
  void step_slice(Frame& frame, double time, int steps) const;
  void finish_frame(Frame& frame, State& state, double frame_time) const;

  PondSetup setup_;
  PondModes modes_;
  std::vector<FloatModel> floats_;
  std::size_t part_count_ = 0;
  double fastest_ = 0;  ///< wave [rad/s]
};

}  // namespace ft::inline solvers
