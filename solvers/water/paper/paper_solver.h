// The water of the paper (O'Brien and Hodgins 1995, Dynamic Simulation of Splashing Fluids): columns joined by pipes
// (pipes.h) on which bodies press from outside (under_bodies.h), and droplets (paper_splash.h).
//
// Right for ripples and waves that are long against the depth. Wrong by design: no momentum goes with the water, so a
// dam that breaks leaves 0.56 of its depth at its place, not 4/9, and its front is less than half as fast; all waves
// have one speed; the drag of bodies pushes no water back. Steps are explicit and as long as waves, bodies and what
// floats allow; the same bytes with any number of threads and after a resume.
#pragma once

#include <memory>

#include "baker/core/state.h"
#include "solvers/water/float_motion.h"
#include "solvers/water/paper/paper_setup.h"
#include "solvers/water/water_core.h"

namespace ft::inline solvers {

struct PaperScratch;

/// Blocks of its states: "depth" of cells, "pipes_x", "pipes_z", "pipes_xz", "pipes_zx" of cells (pipes.h), "tops" of
/// cells, "floats" (14 numbers a body), "droplets" (8 each), "account" (outflow [m3], next id, frames, whether it has
/// begun).
class PaperSolver {
 public:
  /// Refuses, by a usage error that says all, what check_paper_setup() finds.
  static Result<PaperSolver> make(PaperSetup setup);
  PaperSolver(PaperSolver&&) noexcept;
  PaperSolver& operator=(PaperSolver&&) noexcept;
  ~PaperSolver();

  const PaperSetup& setup() const { return setup_; }
  State initial_state() const;
  /// Moves a state on by one frame of `frame_time` [s] and its number by one. Driven bodies go in straight lines from
  /// the frame's start to its end; the same ones in each frame, in the same order. Water in whose place one stands when
  /// it is first seen is taken away, and booked as outflow.
  WaterReport advance_frame(State& state, double frame_time, std::span<const DrivenBody> driven = {});

  std::vector<double> depths(const State& state) const;  ///< of each cell, x fastest [m]
  /// Height of the water's top: in open water its surface, under a body what reaches up to it [m].
  std::vector<double> tops(const State& state) const;
  double bed(std::size_t cell) const;  ///< m
  /// Of each cell, mean over the depth [m/s]; 0 in films.
  std::vector<Vec2> velocities(const State& state) const;
  std::vector<Droplet> droplets(const State& state) const;
  std::vector<RigidMotion> floats(const State& state) const;
  WaterLedger ledger(const State& state) const;

 private:
  explicit PaperSolver(PaperSetup setup);

  PaperSetup setup_;
  std::vector<FloatingHull> floats_;
  std::unique_ptr<PaperScratch> scratch_;
  double still_ = 0;  ///< potential of the columns at the start, by density and gravity [m4]
};

}  // namespace ft::inline solvers
