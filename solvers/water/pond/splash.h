// Water that is thrown, flies and lands. What a splash throws comes of the energy that the water took from a body
// (float_dynamics.h; crowns of driven bodies; jets of cavities); it is taken from the surface where it leaves and given
// back where it lands, with its momentum downwards. Where droplets land, foam is left.
// Approximated: sideways momentum of what lands is lost; what leaves does not push back on the surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solvers/water/droplet_bodies.h"
#include "solvers/water/pond/pond_setup.h"
#include "solvers/water/pond/volume_layers.h"

namespace ft::inline solvers {

/// A ring of water that leaves.
struct Throw {
  double x = 0, z = 0, radius = 0;               ///< of the ring; pool [m]
  double slow = 0, fast = 0;                     ///< speeds, spread evenly [m/s]
  double steep_least = 0.96, steep_most = 1.48;  ///< elevations, outwards [rad]; 55 to 85 degrees
  double energy = 0;                             ///< kinetic, of all that is thrown [J]
  std::uint64_t source = 0;                      ///< for random keys: each once in a frame
};

struct SplashWater {
  double gravity = 9.81, density = 1000, frame_time = 0;
  std::uint64_t seed = 1;
  int frame = 0;
};

/// How droplets have come from where they were thrown to where they are at the frame's end.
struct ThrownWays {
  std::vector<Vec3> starts;   ///< pool [m]
  std::vector<double> since;  ///< of the frame, 0 to 1
};

/// Volume that was thrown [m3]; taken from the layers' surface around the ring. next_id counts on.
double throw_water(const Throw& t, const SplashSettings& settings, const SplashWater& water,
                   std::span<const double> heights, const PondModes& modes, std::vector<Droplet>& droplets,
                   double& next_id, ThrownWays& ways, VolumeLayers& volumes);

struct Landed {
  int count = 0;
  double gone = 0;  ///< volume that flew over the edge [m3]
};

/// What droplets meet in a frame: driven bodies and what floats, from its start to its end; pool axes.
struct PondMet {
  DropletBodies bodies;
  std::vector<RigidPose> from, to;
  /// Sets the bodies to a step between shares of the frame.
  void set_step(double share0, double share1);
};

/// A frame of flight with drag of the air among bodies; landed volumes go to the layers, their impulses over density
/// [m4/s] to `pushes`, their foam (area covered, 1) to the grid.
Landed fly(const PondModes& modes, const SplashWater& water, std::span<const double> heights, PondMet& met,
           std::vector<Droplet>& droplets, VolumeLayers& volumes, VolumeLayers& pushes, std::span<double> foam);

/// Foam over an area [m2], shared out to the cells around a place of the pool.
void add_foam(const PondModes& modes, double x, double z, double area, std::span<double> foam);

}  // namespace ft::inline solvers
