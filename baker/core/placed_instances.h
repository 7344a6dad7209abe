// Instances as one mesh in the world, for whoever looks at their surfaces.
#pragma once

#include <span>
#include <vector>

#include "baker/core/output_frame.h"

namespace ft {

struct PlacedInstances {
  std::vector<Triangle> triangles;  ///< of all, instance by instance
  std::vector<int> instance_of_vertex;
};

/// which: of each instance, its prototype.
PlacedInstances instances_as_mesh(std::span<const Mesh> prototypes, std::span<const int> which);

/// The vertices of instances_as_mesh() in a frame [m].
std::vector<Vec3> placed(std::span<const Mesh> prototypes, std::span<const int> which, const FrameData& frame);

}  // namespace ft
