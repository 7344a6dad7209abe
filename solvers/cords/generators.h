// Nets, ropes and chains from a few measures, or from the edges of any mesh; strands are joined.
#pragma once

#include <string_view>

#include "baker/core/mesh.h"
#include "baker/core/result.h"
#include "solvers/cords/cord_graph.h"

namespace ft::inline solvers {

/// A net of diamonds that hangs from a rim: knots in rings, each ring turned by half a column against the one above it.
/// The defaults are a basketball net's: 12 loops, a ring of 18 inches, and a lower opening that checks the ball.
struct NetMeasures {
  int columns = 12;             ///< loops at the rim, >= 3
  int rows = 6;                 ///< rings of knots below the rim, >= 1; two make a diamond
  double radius_top = 0.225;    ///< of the rim [m], > 0
  double radius_bottom = 0.12;  ///< [m], > 0; it tapers evenly
  double length = 0.42;         ///< from the rim down [m], > 0
  int pieces = 2;               ///< cords of one side of a diamond, >= 1
  Vec3 centre = Vec3::Zero();   ///< of the rim [m]
};

/// Knots come first, ring by ring from the rim, each from +x towards +z; every knot of the rim is held.
CordGraph diamond_net(const NetMeasures& measures);

struct RopeMeasures {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< its ends [m], apart
  int pieces = 32;                              ///< >= 1; of a rope with knots: from each to the next
  int knots = 0;          ///< points that are heavier, evenly spaced, the last at `to`; 0: a plain rope
  double knot_share = 0;  ///< mass of each knot, in units of the rope's without knots
  bool hold_from = true, hold_to = false;
};

/// Points in order from `from` to `to`.
CordGraph rope(const RopeMeasures& measures);

/// Every edge of the mesh's faces as `pieces` >= 1 cords; vertices without a face are left out, the others come first
/// and keep their order. Held are those with a weight above 0 in the group; none when its name is empty. Refused: no
/// such group, an edge without length, more than a million cords.
Result<CordGraph> cords_of_mesh(const Mesh& mesh, std::string_view held_group, int pieces);

}  // namespace ft::inline solvers
