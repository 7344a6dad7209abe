// What all models of water have in common: a rectangle of columns over x and z, in which bodies go and float, and
// droplets that fly above it. Each keeps its own numbers in the blocks of a State; see shallow/, pond/ and paper/.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "baker/core/state.h"
#include "baker/core/wrench.h"
#include "solvers/water/water_body.h"

namespace ft::inline solvers {

/// The grid on which surfaces are told: cell (i, k), x fastest, has its middle at origin + (i + 1/2, k + 1/2) cell.
struct WaterGrid {
  Vec2 origin = Vec2::Zero();  ///< least x and z [m]
  double cell = 0;             ///< m
  int nx = 0, nz = 0;

  std::size_t count() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(nz); }
};

/// Of what a frame did to a driven body.
struct WaterOnBody {
  Wrench mean;           ///< over the frame, the torque about the world's origin
  double peak = 0;       ///< largest force of a step [N]
  double wet_share = 0;  ///< of the frame, during which there was any [1]
};

struct WaterReport {
  WaterLedger ledger;                 ///< at the frame's end
  double kinetic = 0, potential = 0;  ///< of columns, droplets and what floats; potential of columns against the
                                      ///< start's, of what floats against y = 0 or the level [J]
  int steps = 0;                      ///< of the whole domain
  int local_steps = 0;                ///< of parts of it, beyond those
  int iterations = 0;                 ///< of implicit solves, all steps
  int unsettled = 0;                  ///< steps whose solve did not settle
  int thrown = 0;                     ///< droplets in this frame
  int airborne = 0;                   ///< droplets in the air at its end
  std::optional<double> fastest;      ///< of the water in columns [m/s]
  std::vector<WaterOnBody> forces;    ///< on each driven body
  bool dry = false;                   ///< water was pushed down to its ground, and the model cannot leave that dry
  bool finite = true;
};

/// What a water takes, before it is baked.
struct WaterCost {
  double bytes = 0;    ///< of memory
  double seconds = 0;  ///< of one core, for a frame in which nothing falls in; measured on a machine of 2023
};

/// The surface as it is seen.
struct WaterSurface {
  std::vector<double> height;  ///< of each cell [m]; where it is dry, of the ground
  std::vector<char> wet;       ///< 1: there is water
};

class WaterCore {
 public:
  virtual ~WaterCore() = default;

  virtual WaterGrid grid() const = 0;
  virtual int float_count() const = 0;
  virtual WaterCost cost(double frame_time) const = 0;
  /// At rest, what floats where it starts. Its frame and time are the caller's.
  virtual State initial_state() const = 0;
  /// By a frame of so many seconds. bodies: the same ones in the same order in every frame.
  virtual WaterReport advance(State& state, double frame_time, std::span<const DrivenBody> bodies) = 0;

  virtual WaterLedger ledger(const State& state) const = 0;
  virtual void surface(const State& state, WaterSurface& out) const = 0;
  /// Of the water at the surface, in each cell [m/s]; y is not used.
  virtual void surface_flow(const State& state, std::span<Vec3> out) const = 0;
  /// Names of what else is known of the surface in each cell, 0 to 1, and the values of one of them:
  ///   foam   share of the surface that foam covers
  ///   wet    1 under water; below 1 the mark that water has left, as it dries; 0 where there has been none
  virtual std::span<const std::string> scalar_names() const { return {}; }
  virtual void scalar(const State& /*state*/, std::size_t /*index*/, std::span<double> out) const {
    std::fill(out.begin(), out.end(), 0.0);
  }
  /// Air in the water below its surface, which the surface's height knows nothing of.
  virtual std::vector<WaterCavity> cavities(const State& /*state*/) const { return {}; }
  virtual std::vector<Droplet> droplets(const State& state) const = 0;
  /// Of all that floats, in the order of the setup.
  virtual std::vector<RigidMotion> floating(const State& state) const = 0;
};

}  // namespace ft::inline solvers
