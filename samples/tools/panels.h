// Rectangles of cloth that hang in the open: flags on their masts, curtains in their folds. For make_set.
#pragma once

#include "baker/core/mesh.h"

namespace ft::sets {

struct FlagSettings {
  double length = 1.5;  ///< m, along x from the mast
  double height = 1.0;  ///< m
  double top = 3;       ///< m, of its upper edge
  double edge = 0.045;  ///< m, of its quads
  double slack = 0.01;  ///< m, sideways at its free end: a flat one would not know where to go
};

/// In the plane z = 0 from x = 0 on; the group "mast" is its sleeve there, a quad wide.
Mesh make_flag(const FlagSettings& settings);

struct CurtainSettings {
  double width = 2.0;     ///< m of rail, along x, centred
  double fullness = 1.6;  ///< m of cloth by m of rail
  double height = 2.4;    ///< m, down to a hand's breadth above the ground
  double bottom = 0.06;   ///< m
  int folds = 10;         ///< with a ring at the front and at the back of each
  double edge = 0.04;     ///< m, of its quads
};

/// Hangs in folds about the plane z = 0; red are the vertices that are held at the rail.
Mesh make_curtain(const CurtainSettings& settings);

}  // namespace ft::sets
