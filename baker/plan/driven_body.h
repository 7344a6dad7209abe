// The body of a character as stand-ins meet it: its centre of mass, and points of its skin with their areas, volumes
// and velocities, frame by frame from the imported surface. Axes are the world's, moved along with the centre; the
// limbs move against them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "baker/core/trajectory.h"
#include "solvers/standins/deviation.h"

namespace ft::inline baker {

/// Points of a surface that stand for it: triangles that lie together, belong to one part and face alike.
struct BodyPoint {
  std::vector<Triangle> triangles;
  double volume = 0;  ///< m3
};

/// Of all triangles, or of those that are chosen. bind: positions of the bind pose; across: size of a point [m], > 0;
/// volume: of the body, shared out by what lies between triangles and the middle of their part [m3].
std::vector<BodyPoint> body_points(const Surface& surface, std::span<const Vec3> bind, std::span<const Triangle> chosen,
                                   double across, double volume);

/// Its motion over frames from 0 to the last, fps a second; smooth in between. mass: kg, > 0.
YieldingBody driven_body(const Trajectory& trajectory, const std::vector<BodyPoint>& points, double mass,
                         int frame_count, double fps);

}  // namespace ft::inline baker
