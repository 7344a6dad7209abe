// What all kinds of water share: who is in it, what flies out of it, and the account of where all the water is.
// World axes: y is up, water lies in x and z.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/rigid.h"

namespace ft::inline solvers {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// A body whose motion is known: its vertices go in straight lines from the frame's start to its end.
struct DrivenBody {
  std::span<const Triangle> triangles;  ///< closed, normals outward
  std::span<const Vec3> from, to;       ///< m
};

/// A body that water moves, as it is made.
struct FloatingBody {
  std::string name;
  std::vector<Vec3> positions;  ///< about its centre of mass, body axes [m]
  std::vector<Triangle> triangles;
  RigidMass mass;
  double drag = 0.47;  ///< coefficient on the area that faces the flow [1]; 0.47 ball, about 1 box
};

/// A body that floats, and where it starts.
struct PlacedFloat {
  FloatingBody body;
  RigidMotion start;
};

/// Water that flies.
struct Droplet {
  std::uint64_t id = 0;  ///< none twice in a bake
  Vec3 place = Vec3::Zero(), velocity = Vec3::Zero();
  double volume = 0;  ///< m3
};

/// A slice of air under the surface.
struct AirDisc {
  Vec3 centre = Vec3::Zero();        ///< m
  double radius = 0, thickness = 0;  ///< m; it lies level
};

/// Air behind something that has dived in.
struct WaterCavity {
  double level = 0;              ///< of the water around, at rest [m]
  std::vector<AirDisc> discs{};  ///< from the top down, each depth once; where some are missing it has closed
};

/// Where the water is [m3]. The total never changes but by rounding.
struct WaterLedger {
  double columns = 0;   ///< in the height field
  double droplets = 0;  ///< in the air
  double pending = 0;   ///< taken from the columns, not yet flying
  double cavities = 0;  ///< that cavities have pushed out of their place, below zero while they are open
  double outflow = 0;   ///< gone over the edge of the domain, for good; below zero where more came in

  double total() const { return columns + droplets + pending + cavities + outflow; }
};

}  // namespace ft::inline solvers
