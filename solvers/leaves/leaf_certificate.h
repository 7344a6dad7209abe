// Whether a leaf is where it may be at a frame's end, exactly: no edge of it through a triangle of a body and none of a
// body through one of its, no vertex below a ground, and not as a whole inside a closed body; and where it is not, the
// way out, which always exists.
#pragma once

#include <span>
#include <vector>

#include "solvers/leaves/leaf_bodies.h"
#include "solvers/leaves/leaf_shape.h"

namespace ft::inline solvers {

struct LeafVerdict {
  int crossings = 0;             ///< pairs of an edge and a triangle
  bool inside = false;           ///< of a closed body, whole
  double below_ground = 0;       ///< of the deepest vertex, below what caches can tell from the ground [m]
  Vec3 out = Vec3::Zero();       ///< unit, away from what it crosses; zero where nothing is known
  double depth = 0;              ///< to the surface, where it is inside [m]
  Vec3 velocity = Vec3::Zero();  ///< of that body there [m/s]
  bool ok() const { return crossings == 0 && !inside && below_ground <= 0; }
};

/// At the end of a slice. rim: the leaf's vertices, world [m]; slice_time: of a slice [s].
LeafVerdict judge_leaf(const LeafBodies& bodies, std::span<const LeafGround> grounds, const LeafShape& shape,
                       std::span<const Vec3> rim, const Vec3& centre, int slice, double slice_time);

/// Moves a leaf, and its rim, to where its verdict is ok, by as little as its steps tell. Returns how far [m], 0 if it
/// was; negative where none was found within some metres.
double bring_out(const LeafBodies& bodies, std::span<const LeafGround> grounds, const LeafShape& shape,
                 std::vector<Vec3>& rim, Vec3& centre, int slice, double slice_time, double margin,
                 LeafVerdict& verdict);

}  // namespace ft::inline solvers
