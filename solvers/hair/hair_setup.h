// What a shot says of its hair. See hair_solver.h for what the solver does.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/output_shape.h"
#include "baker/core/trajectory.h"
#include "baker/core/types.h"
#include "solvers/wind/wind.h"

namespace ft::inline solvers {

/// Of what strands are. A strand may stand for a bundle of N hairs: mass and stiffness both grow by N, and it moves as
/// each of them does; so it is a hair's numbers that are asked.
struct HairMaterial {
  double radius = 40e-6;    ///< m; 30 to 50 um
  double young = 3.9e9;     ///< E [Pa]; dry hair 3.9e9, wet 1e9
  double shear = 0.89e9;    ///< G [Pa]
  double density = 1320;    ///< kg/m3
  double stiffness = 1;     ///< of bending and twisting, by a hair's: cohesion of a lock [1]; 1 to 100
  double damping = 5e-3;    ///< of strains: time constant [s]; 0 to 0.05
  double drag = 4;          ///< towards the motion of the root: friction among hairs [1/s]; 0 swings for ever
  double air_drag = 0.5;    ///< towards the air, by speed [1/m]: of hair that others shelter; 25 a hair alone
  double friction = 0.3;    ///< Coulomb, on what it lies on [1]
  double pressure = 1.5;    ///< of strands that are denser than combed on one another (hair_crowd.h) [m2/s2]; 0 none
  double mutual_drag = 6;   ///< towards the mean motion of what is around [1/s]; 0 none
  double thickness = 3e-3;  ///< of a strand as others meet it: it stays so far away, if it was combed so [m]
};

struct HairStrand {
  std::uint64_t id = 0;         ///< as caches know it; any, each once
  std::vector<Vec3> positions;  ///< root first, in the scalp's bind pose [m]; all strands have as many
  double width = 80e-6;         ///< diameter, as drawn [m]
  int held = 1;                 ///< so many vertices from the root on stay where they are on the root's frame: tied
};

/// A strand that is not solved but goes with guides.
struct BetweenStrand {
  std::vector<Vec3> positions;            ///< root first, in the scalp's bind pose [m]; as many as the guides have
  std::array<int, 3> guides{-1, -1, -1};  ///< into HairSetup::strands, the nearest first; -1: none
  std::array<double, 3> share{0, 0, 0};   ///< at the root; their sum is 1
  double width = 80e-6;                   ///< m
};

/// Where a vertex of a hair mesh is along a strand of HairSetup::strands.
struct MeshRider {
  int strand = -1;   ///< -1: none; it stays beside the nearest root
  double along = 0;  ///< 0 at the root, 1 at the tip
};

/// What strands meet. Sheets have no inside: a strand stays on the side where it is.
struct HairBody {
  std::string name;
  std::shared_ptr<const Trajectory> trajectory;
  double friction = 1;  ///< times the strand's
  bool sheet = false;
};

struct HairSetup {
  std::string name = "hair";
  int first_frame = 1;
  double fps = 24;
  int preroll_frames = 24;
  Vec3 gravity = Vec3(0, -k_gravity, 0);  ///< m/s2
  std::optional<Vec3> combed_gravity;     ///< under which the groom stands still, where it is not gravity [m/s2]
  std::shared_ptr<const Wind> wind;       ///< null: still air
  HairMaterial material;
  double hairs = 0;  ///< that all strands together stand for, in forces; 0: one each, those between them if there are
  std::vector<HairStrand> strands;
  std::vector<BetweenStrand> between;       ///< a second system, "NAME_strands", where there are any
  Mesh ridden;                              ///< a system more, of its own name, if it has vertices: in the bind pose
  std::vector<MeshRider> riders;            ///< for each of its vertices
  std::shared_ptr<const Trajectory> scalp;  ///< on which the roots are: the nearest point of its bind pose
  std::vector<HairBody> bodies;             ///< met; the scalp is one of them if it is
  std::vector<int> teleports;               ///< frames into which the scalp jumps: strands are carried along
  int least_steps = 4;                      ///< of a frame
  int most_steps = 32;
};

/// Attribute of caches: HairStrand::held of each strand.
inline constexpr const char* k_held = "followthrough_held";

/// What caches know of the setup's strands: vertices, widths, ids, and what grooming tools ask for (`groom_...`, as
/// Unreal's import reads them).
SystemShape curves_of(const HairSetup& setup);
/// The same of those between them. Their ids are their numbers.
SystemShape curves_between(const HairSetup& setup);

}  // namespace ft::inline solvers
