// [leaves.NAME] of the shot file: what the wind blows about.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/types.h"
#include "io/shot/secondary.h"

namespace ft::inline baker {

struct LeavesSpec final : SecondarySpec {
  int count = 1000;
  int seed = 1;
  std::filesystem::path over;    ///< OBJ on whose faces they lie; empty: over the rectangle of position and size
  std::filesystem::path placed;  ///< or a place for each: x, y, z, and as one likes heading in degrees and scale
  Vec3 position = Vec3::Zero();  ///< centre of the rectangle's lower side, added to a mesh and to places [m]
  Vec3 size = Vec3::Zero();      ///< x and z of the rectangle; y: up to which height they hang in the air [m]
  std::filesystem::path mesh;    ///< of a leaf: OBJ, x along its rib, y up
  double length = 0.08;          ///< of a leaf without mesh, along its rib [m]
  double width = 0.05;           ///< [m]
  double fold = 8;               ///< by which its panels rise from the rib [degrees]
  double variation = 0.25;       ///< of lengths, and of masses by area, evenly up and down [1]
  double mass_per_area = 0.08;   ///< kg/m2
  double friction = 0.5;         ///< Coulomb [1]
  double lift = 0.4;             ///< by dynamic pressure, of a lying leaf [1]
  double adhesion = 0.1;         ///< of a lying leaf [N/m2]
  double near = 0;               ///< those that start so near to the camera bend, and are meshes; 0: none [m]
  Vec3 camera = Vec3::Zero();    ///< m
  double bending = 1e-4;         ///< stiffness of those [N m]
  std::vector<std::string> meets{"*"};

  /// Of the system of near leaves.
  std::string near_name() const { return name + "_near"; }
};

}  // namespace ft::inline baker
