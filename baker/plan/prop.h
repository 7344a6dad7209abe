// Rigid props: primaries of a plain shape, and imported primaries that move as one. A prop follows its track until it
// is released, and then flies on by itself: in one-way and hybrid bakes along this path, in two-way bakes as its
// secondaries let it.
#pragma once

#include <functional>
#include <limits>
#include <memory>

#include "baker/core/rigid.h"
#include "baker/core/trajectory.h"
#include "io/shot/shot.h"
#include "solvers/standins/body_state.h"

namespace ft::inline baker {

using RigidTrack = std::function<RigidMotion(double time)>;  ///< s from the first frame of the shot

struct Prop {
  std::string name;
  std::vector<Vec3> surface;  ///< body axes, about the centre of mass [m]
  std::vector<Triangle> triangles;
  std::vector<ShapeSample> samples;  ///< of its surface and its inside, for stand-ins
  RigidMass mass;                    ///< mass 0: not known, and then the inertia is that of 1 kg
  RigidTrack track;
  double release = std::numeric_limits<double>::infinity();  ///< it flies by itself from then on [s]
  bool release_on_contact = false;                           ///< or when it meets a secondary, in a two-way bake
};

/// Turned about x, then y, then z of the world.
Quat rotation_of_degrees(const Vec3& degrees);

/// Of a primary with a shape. The shot was judged.
Prop prop_of_shape(const PrimarySpec& spec, const Shot& shot);

/// Of an imported primary; refuses one that does not move as a rigid body in the shot. mass: kg, 0 if not known.
Result<Prop> prop_of_trajectory(const PrimarySpec& spec, const Shot& shot, std::shared_ptr<const Trajectory> trajectory,
                                double mass);

/// The prop's surface along a track; before the shot it stands where it starts.
std::unique_ptr<Trajectory> prop_trajectory(const Prop& prop, RigidTrack track, double preroll);

}  // namespace ft::inline baker
