// [hair.NAME] of the shot file: what grows on a body.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/types.h"
#include "baker/systems/hair/growth.h"
#include "io/shot/secondary.h"

namespace ft::inline baker {

struct HairSpec final : SecondarySpec, Growth {  // Growth: of what grows from a region; its vertices of all
  std::filesystem::path guides;                  ///< .tfx, .obj or .abc
  double scale = 1;                              ///< m per unit of it
  Vec3 position = Vec3::Zero();                  ///< added to its places [m]
  int count = 0;                                 ///< of guides that are solved, evenly chosen; 0: all
  std::string leave_out;                         ///< ids of guides of the file that are not solved: "3, 10-12"
  std::filesystem::path region_mesh;             ///< .obj: where it grows, instead of guides
  Vec3 region = Vec3::Zero();         ///< middle of a ball in which the body has hair, on the body as garments lie [m]
  double region_radius = 0;           ///< of it; 0: none [m]
  Vec3 parting_at = Vec3::Zero();     ///< a place on a parting line, and
  Vec3 parting_along = Vec3::Zero();  ///< its direction; zero: none
  int seed_number = 1;
  int strands = 0;          ///< between the guides; 0: none
  double clumping = 0.5;    ///< of those
  double hairs = 0;         ///< that all of it stands for; 0: one each
  Vec3 tie = Vec3::Zero();  ///< centre of a band, on the body as garments lie on it [m]
  double tie_radius = 0;    ///< strands are held from the root to where they leave it; 0: no band [m]
  double width = 1e-4;      ///< diameter of a strand as drawn [m]
  double radius = 40e-6;    ///< of a hair [m]
  double stiffness = 1;     ///< by a hair's [1]
  double damping = 5e-3;    ///< of strains [s]
  double drag = 4;          ///< 1/s
  double air_drag = 0.5;    ///< 1/m
  double friction = 0.3;    ///< Coulomb [1]
  double pressure = 1.5;    ///< m2/s2
  double mutual_drag = 6;   ///< 1/s
  double thickness = 3e-3;  ///< m
  std::vector<std::string> meets{"*"};

  bool grows() const { return !region_mesh.empty() || region_radius > 0; }
};

}  // namespace ft::inline baker
