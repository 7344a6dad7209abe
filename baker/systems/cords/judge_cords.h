// Judges cords of a bake from the tubes that are cached. Tubes run through each other at every knot and along the prop,
// so what is judged is their middle lines, which is what the solver moves.
#pragma once

#include <span>
#include <vector>

#include "baker/core/edge_strain.h"
#include "baker/core/mesh.h"
#include "baker/core/result.h"
#include "solvers/base/solver.h"

namespace ft::inline baker {

/// Middle lines of tubes of solvers/cords/tubes.h: a point in every ring, a cord from ring to ring.
struct MiddleLines {
  int point_count = 0;
  RestEdges cords;
};

/// From the topology file; refuses what is no mesh of such tubes (k_input).
Result<MiddleLines> middle_lines(const Mesh& tubes);
/// Appends the points for these vertices [m].
void append_middle_points(std::span<const Vec3> vertices, std::vector<Vec3>& out);
/// The vertex of the tubes that begins a point's ring.
int vertex_of_point(int point);

struct CordsAndBody {
  int crossings = 0;   ///< exact: triangles that cords go through
  int crossed = -1;    ///< a point of the first cord that does; -1: none
  double gap = 0;      ///< least distance of cords and surface [m]
  double deepest = 0;  ///< of the points inside the body [m]
  int inside = -1;     ///< the deepest point; -1: none
};

/// Cords between `points` beside a closed surface, in one frame.
CordsAndBody judge_cords(std::span<const Edge> cords, std::span<const Vec3> points, std::span<const Vec3> surface,
                         std::span<const Triangle> triangles);

}  // namespace ft::inline baker
