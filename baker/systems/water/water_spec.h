// [water.NAME] of the shot file: a rectangle of water, what goes through it and what floats in it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/types.h"
#include "io/shot/secondary.h"

namespace ft::inline baker {

struct WaterSpec final : SecondarySpec {
  std::string model;             ///< "shallow", "pond" or "paper"; empty: as its depth and size advise
  Vec3 position = Vec3::Zero();  ///< middle of the still surface [m]
  Vec3 size = Vec3::Zero();      ///< along x and z [m]
  double depth = 0;              ///< of the still water over level ground [m]; 0: the bed says it
  std::filesystem::path bed;     ///< .obj: ground under the water, in the world; not of a pond
  double cell = 0;               ///< of the grid [m]; 0: chosen
  std::string edges = "wall";    ///< "wall", "open" or "drain", on all four sides
  double roughness = 0.012;      ///< of the bed, Manning's [s/m^(1/3)]
  double splash = 1;             ///< times what theory throws up [1]
  double cavity = 1;             ///< how fast it widens behind what dives in, by a clean entry [1]
  double float_drag = 0.47;      ///< coefficient of what floats [1]
  int seed = 1;
  std::vector<std::string> floats;  ///< primaries that the water moves
  std::vector<std::string> meets{"*"};

  std::string droplets_name() const { return name + "_droplets"; }
};

}  // namespace ft::inline baker
