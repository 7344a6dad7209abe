// A floating body as the pond sees it: a closed surface in parts, each of which displaces its own volume up to its own
// level, so that pitch and roll make waves and feel them. A ball is one part with closed forms; other surfaces are cut
// into columns across their length and width.
#pragma once

#include <array>
#include <vector>

#include "solvers/water/float_meeting.h"
#include "solvers/water/pond/pond_setup.h"

namespace ft::inline solvers {

/// A piece of a body. Its surface may hold triangles of either sign whose sum is closed: enough for volumes.
struct FloatPart {
  double ball_radius = 0;      ///< > 0: a ball about the origin, corners are empty [m]
  std::vector<Vec3> corners;   ///< of triangles, three by three; body axes [m]
  double volume = 0;           ///< m3
  Vec3 centre = Vec3::Zero();  ///< of volume; where it pushes the waves; body axes [m]
};

/// What of a part lies below a level.
struct Submerged {
  double volume = 0;           ///< m3
  double area = 0;             ///< of the cut by the water [m2]
  Vec3 centre = Vec3::Zero();  ///< of the submerged volume; world [m]
  double top = 0;              ///< height of the part's highest point [m]
};
Submerged submerged(const FloatPart& part, const RigidPose& pose, double level);

/// Model of a body; never changes.
struct FloatShape {
  std::vector<FloatPart> parts;
  double volume = 0;                 ///< m3
  double depth = 0;                  ///< d of its kernel [m]: wave_kernel.h
  Vec3 added = Vec3::Constant(0.5);  ///< added mass over displaced mass, body axes, slow motion [1]
  Vec3 face = Vec3::Zero();          ///< area that it shows along its axes [m2]
  ContactSpheres contact;            ///< what it meets others with
  double reach = 0;                  ///< farthest point from the centre of mass [m]
  double rest_height = 0;            ///< of its centre of mass above the level at rest, upright [m]
};

/// By its start attitude. density: of the water.
FloatShape float_shape(const PondFloat& body, double density);

/// Share of the added mass that a sideways motion has at once, when half under; it grows to 1 with full submersion.
/// 0.273 of 0.5: Hulme's (1982) hemisphere.
double sudden_share(double submerged_share);

}  // namespace ft::inline solvers
