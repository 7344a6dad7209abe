// Water that is shallow: puddles, shores, ditches; what steps and falls into it, and what floats in it, both ways.
//
// A height field over x and z (flow.h), near bodies with the head of near_water.h, droplets above (splash.h). A frame
// is a few steps of the whole; where water is fast or near bodies a patch takes its own shorter ones in each (patch.h),
// and what goes over the patch's rim is the same on both sides. The same bytes with any number of threads and after a
// resume.
#pragma once

#include <memory>

#include "baker/core/state.h"
#include "solvers/water/float_motion.h"
#include "solvers/water/shallow/flow.h"
#include "solvers/water/shallow/shallow_setup.h"

namespace ft::inline solvers {

/// On a body, over a frame: torques of driven ones about the world's origin, of floating ones about their centres.
struct WaterForce {
  Wrench mean, peak;  ///< peak: of the step with the largest force
};

/// What a frame took and did.
struct ShallowReport {
  int steps = 0, patch_steps = 0, retries = 0;
  int newton_iterations = 0, linear_iterations = 0;
  int failed_solves = 0;  ///< Newton did not come near its tolerance
  int near_cells = 0;     ///< the most of a step
  int droplets = 0, droplets_thrown = 0;
  double volume_thrown = 0;  ///< m3
  double fastest = 0;        ///< the largest velocity and k_wave_share of the waves' together, which sets steps [m/s]
  double rim_fastest = 0;    ///< outward, from under a body [m/s]
  double lowest_depth = 0;   ///< the lowest thickness of a cell at any step: never below 0 [m]
  double kinetic = 0, potential = 0;  ///< of the water at the frame's end, heights from y = 0 [J]
  double floats_energy = 0;           ///< of floating bodies, kinetic (added mass included) and potential [J]
  WaterLedger ledger;                 ///< at the frame's end
  std::vector<WaterForce> driven, floats;
  bool finite = true;
};

struct ShallowScratch;

/// Blocks of its states: "depth", "u", "w", "qx", "qz", "lift" of cells with the flow's ghosts, "wet" of cells,
/// "floats" (14 numbers a body), "droplets" (8 each: id, place, velocity, volume), "account" (outflow [m3], next id,
/// frames, whether it has begun).
class ShallowSolver {
 public:
  /// Refuses, by a usage error that says all, what check_shallow_setup() finds.
  static Result<ShallowSolver> make(ShallowSetup setup);
  ShallowSolver(ShallowSolver&&) noexcept;
  ShallowSolver& operator=(ShallowSolver&&) noexcept;
  ~ShallowSolver();

  const ShallowSetup& setup() const { return setup_; }
  State initial_state() const;
  /// Moves a state on by one frame of `frame_time` [s] and its number by one. Driven bodies go in straight lines from
  /// the frame's start to its end; the same ones in each frame, in the same order. Water in whose place one stands when
  /// it is first seen is taken away, and booked as outflow.
  ShallowReport advance_frame(State& state, double frame_time, std::span<const DrivenBody> driven = {});

  // Of a state. Cells: nx x nz, x fastest.
  std::vector<double> depths(const State& state) const;    ///< thickness [m]
  std::vector<double> surface(const State& state) const;   ///< bed + thickness: under a body the water's top [m]
  std::vector<Vec2> velocities(const State& state) const;  ///< in x and z, at the cells' middles [m/s]
  std::vector<double> wet(const State& state) const;       ///< 1 under water, below 1 where it has dried for a while
  /// Whether a body stands on or in the cell's water, whose surface is then not to be drawn: 1, else 0.
  std::vector<char> covered(const State& state) const;
  std::vector<Droplet> droplets(const State& state) const;
  std::vector<RigidMotion> floats(const State& state) const;
  WaterLedger ledger(const State& state) const;

 private:
  explicit ShallowSolver(ShallowSetup setup);

  ShallowSetup setup_;
  Flow model_;  ///< bed, sides and levels beyond open ones; its water is nobody's
  std::vector<FloatingHull> floats_;
  std::unique_ptr<ShallowScratch> scratch_;
};

}  // namespace ft::inline solvers
