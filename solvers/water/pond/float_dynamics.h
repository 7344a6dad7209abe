// Bodies that float: what water does to them and they to water, in the paired form that keeps the energy (with slam and
// drag, which only take it). A body is rigid, with six freedoms; each of its parts is a source of wave_step.h that
// displaces V = V(pose, level) up to its own level <phi, eta>. Forces on a part:
//   buoyancy rho g V at the centre of what is submerged; -(rho V + added mass) g <chi, gradient eta> along the surface;
//   deep ones feel -(rho V + added mass) g <k phi, eta>; half the growth of the added mass takes momentum and the other
//   half, on the way in only, is the slam of von Karman (1929), whose loss is what splashes are made of; drag.
// Approximated: drag pushes no water back; the added mass has no reaction through the level.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "solvers/water/pond/float_shape.h"
#include "solvers/water/pond/wave_step.h"

namespace ft::inline solvers {

/// Model.
struct FloatModel {
  FloatShape shape;
  RigidMass mass;
  double drag = 0.47, restitution = 0.3;
  std::shared_ptr<const KernelTable> kernel;
  std::size_t first_part = 0;  ///< in lists of all parts
};

struct FloatLosses {
  double slam = 0, drag = 0, contact = 0;  ///< J
};

/// All that moves of the bodies; pool coordinates.
struct Floats {
  std::vector<RigidMotion> motion;
  std::vector<double> volume;  ///< that each part displaces, as the waves know it [m3]
  /// Velocity of each through water, as its wake remembers it [m/s]: drag begins when a body has gone its own length.
  std::vector<Vec3> wake;
  /// Since the last splash of a body: energy that its entry lost [J], fastest entry [m/s].
  std::vector<double> splash_energy, splash_speed;
};

std::vector<RigidPose> poses_of(const Floats& floats);

/// What is known between two steps; forgotten after the frame.
struct FloatScratch {
  std::vector<Submerged> wet;       ///< of parts
  std::vector<double> top_depth;    ///< of parts [m]
  std::vector<WaveProbe> probes;    ///< of parts
  std::vector<WaveSource> sources;  ///< of parts: what goes into the waves with the next sweep
  std::vector<double> level;        ///< of parts [m]
};

struct FloatWater {
  double gravity = 9.81, density = 1000;
};

/// Sources at the present places that push nothing and read there.
void place_sources(std::span<const FloatModel> models, const Floats& floats, FloatScratch& scratch);
/// New volumes for the levels that the probes read; the sources get what is new.
void find_levels(std::span<const FloatModel> models, Floats& floats, FloatScratch& scratch);
/// Velocities over a time [s].
void kick_floats(std::span<const FloatModel> models, const FloatWater& water, double time, const FloatScratch& scratch,
                 Floats& floats, FloatLosses& losses);
/// Places over a time [s]; before sources are set.
void drift_floats(double time, Floats& floats);
/// From the places before and now: ways of all sources. Keeps the volumes that wait in them.
void move_sources(std::span<const FloatModel> models, std::span<const RigidMotion> before, const Floats& floats,
                  FloatScratch& scratch);
/// Kinetic with added mass, of height, and of the water that they displace [J].
double float_energy(std::span<const FloatModel> models, const FloatWater& water, const Floats& floats,
                    const FloatScratch& scratch);

}  // namespace ft::inline solvers
