// A primary with fewer triangles that stands for one with many, for previews: it moves with some of the finer surface's
// vertices, drawn outwards so far that in the bind pose the finer surface lies inside. Parts, times and placement are
// those of the finer one.
#pragma once

#include <memory>

#include "baker/core/trajectory.h"

namespace ft::inline collision {

/// Edges get `factor` (1..4) times as long where that takes the surface no farther than about `deviation` [m] off
/// (mesh_coarsen.h), but none is made longer than `longest` [m]. Each part keeps a shape of its own: no vertex is drawn
/// into another part's. Depends on the input alone; thread-safe as any trajectory.
std::shared_ptr<const Trajectory> coarse_body(std::shared_ptr<const Trajectory> fine, double factor, double longest,
                                              double deviation);

}  // namespace ft::inline collision
