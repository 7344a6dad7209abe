// [cords.NAME] of the shot file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/types.h"
#include "io/shot/secondary.h"
#include "solvers/cords/cord_settings.h"

namespace ft::inline baker {

/// [cords.NAME]: what follows, of cords: a net, a rope, a chain of knots, the edges of a mesh.
struct CordsSpec final : SecondarySpec, CordSettings {
  std::string shape;                           ///< "net", "rope", "knots", "mesh"
  int columns = 12, rows = 6;                  ///< net: loops at the rim, rings of knots below it
  double radius_top = 0.225;                   ///< net: of the rim [m]
  double radius_bottom = 0.12, length = 0.42;  ///< net [m]
  int points = 0;                              ///< pieces a side, a rope, between two knots, an edge; 0: 2, 32, 4, 1
  Vec3 position = Vec3::Zero();                ///< centre of the rim, start of a rope, offset of a mesh [m]
  Vec3 to = Vec3::Zero();                      ///< rope, knots: its other end [m]
  int knots = 1;                               ///< knots: how many, evenly spaced, the last at the end
  double knot_mass = 0;                        ///< kg each, of `mass`
  std::filesystem::path mesh;                  ///< OBJ whose edges are cords
  double unit_scale = 1;                       ///< m per mesh unit
  std::string up = "y";                        ///< of the mesh
  std::string held;                     ///< rope, knots: "start", "end", "both", "none"; mesh: a vertex group or none
  std::vector<std::string> meets{"*"};  ///< patterns of primaries that they meet beside their own
};

}  // namespace ft::inline baker
