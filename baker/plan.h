// The plan of a bake: everything read, imported, placed and checked before the first frame, so that a fault shows in
// the first second and not after the night. --dry-run stops here and prints it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "baker/hybrid.h"
#include "baker/inputs.h"
#include "baker/joint_body.h"
#include "baker/primary_mass.h"
#include "baker/prop.h"
#include "baker/yielding_character.h"
#include "io/import/import.h"
#include "io/import/teleport_scan.h"
#include "io/shot/file_numbers.h"
#include "solvers/cloth/cloth_solver.h"
#include "solvers/lockstep/lockstep_solver.h"

namespace ft {

struct PrimaryPlan {
  std::string name;
  std::shared_ptr<const Trajectory> trajectory;
  CharacterInfo info;
  TeleportScan scan;
  PrimaryMass mass;
  std::shared_ptr<const Prop> prop;                   ///< null for a character
  RigidTrack track;                                   ///< of a prop: where `trajectory` has it
  std::shared_ptr<const HybridPass> hybrid;           ///< null without one; `trajectory` has it
  std::shared_ptr<const YieldingCharacter> yielding;  ///< of a character with a hybrid pass
};

/// How a garment leaves: in the vertex order of its file, whatever was joined for the simulation. Cords leave as tubes.
struct GarmentOutput {
  std::size_t primary = 0;           ///< whom it is on, into BakePlan::primaries
  std::shared_ptr<const Mesh> mesh;  ///< the file's, placed; with the simulated triangles if the shot file wants those
  std::vector<int> joined_of;        ///< per vertex of the file: its vertex in the simulation; empty: the same
  double pattern_scale = 0;          ///< of the garment
  double weld = 0;                   ///< what is nearer than this was joined [m]; 0: nothing
  FileNumbers in_file;               ///< of the simulated mesh
};

/// Cloths that may meet are solved together and feel each other, with all primaries that they may meet (meeting.h); so
/// are all cords of one primary. Cloth and cords do not feel each other.
struct GroupPlan {
  std::size_t primary = 0;  ///< into BakePlan::primaries: the first that has a secondary of the group
  ClothSetup setup;
  std::vector<GarmentOutput> outputs;            ///< one per garment of setup, or cord system of lockstep
  std::optional<LockstepSetup> lockstep;         ///< a group of cords: then `setup` is not used
  std::shared_ptr<const JointBody> joint{};      ///< setup's primary, where cloth meets several bodies; else null
  std::shared_ptr<const FeasiblePoses> poses{};  ///< of joint; the solver has them, too
  std::vector<std::size_t> bodies{};             ///< the members of joint, into BakePlan::primaries; else empty
  // Without outputs: a hybrid primary alone, whose adjusted motion is cached.
};

struct BakePlan {
  BakeInputs inputs;
  std::vector<PrimaryPlan> primaries;
  std::vector<GroupPlan> groups;
  std::vector<std::string> notes;  ///< what is odd and yet allowed; the same for the same inputs
  double import_seconds = 0;       ///< wall

  const Shot& shot() const { return inputs.shot; }
  /// First frame that is written; frames before it are pre-roll.
  int first_written() const { return shot().write_preroll ? shot().first_frame - shot().preroll : shot().first_frame; }
  int written_count() const { return shot().last_frame - first_written() + 1; }
};

using Importer = std::function<Result<ImportedPrimary>(const ImportRequest&)>;

/// import_cache: folder for import results, may be empty.
Result<BakePlan> make_plan(BakeInputs inputs, const Importer& importer, const std::filesystem::path& import_cache);

}  // namespace ft
