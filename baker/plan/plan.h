// The plan of a bake: everything read, imported, placed and checked before the first frame, so that a fault shows in
// the first second and not after the night. --dry-run stops here and prints it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "baker/core/vertex_flow.h"
#include "baker/plan/hybrid.h"
#include "baker/plan/inputs.h"
#include "baker/plan/primary_mass.h"
#include "baker/plan/prop.h"
#include "baker/plan/yielding_character.h"
#include "baker/systems/interface/system.h"
#include "io/import/import.h"
#include "io/import/motion/placed_character.h"
#include "io/import/repair/teleport_scan.h"
#include "solvers/wind/wind.h"

namespace ft::inline baker {

struct PrimaryPlan {
  std::string name;
  std::string caches;  ///< of a secondary that was baked in an earlier stage (carrier.h): the name of its system
  std::shared_ptr<const Trajectory> trajectory;
  std::shared_ptr<const VertexFlow> flow;  ///< of a liquid, what its surface does; null: it is a body
  CharacterInfo info;
  TeleportScan scan;
  PrimaryMass mass;
  std::shared_ptr<const Prop> prop;                   ///< null for a character
  RigidTrack track;                                   ///< of a prop: where `trajectory` has it
  std::shared_ptr<const HybridPass> hybrid;           ///< null without one; `trajectory` has it
  std::shared_ptr<const YieldingCharacter> yielding;  ///< of a character with a hybrid pass
  /// What a secondary needs that changes joints: the character as it was imported, how, and where it is placed. Null
  /// where none asks for it, and of props and geometry caches.
  std::shared_ptr<const PlacedCharacter> character;
  ImportRequest request;
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();

  /// The name of the cached body.
  const std::string& cache_name() const { return caches.empty() ? name : caches; }
};

struct BakePlan {
  BakeInputs inputs;
  std::vector<PrimaryPlan> primaries;
  std::shared_ptr<const Wind> wind;  ///< never null in a plan
  SystemGroups groups;
  std::vector<std::string> notes;  ///< what is odd and yet allowed; the same for the same inputs
  double import_seconds = 0;       ///< wall
  /// Of a chain: which stage this is, from 0, and of how many. Its groups are those of this stage alone, and behind the
  /// shot's primaries stands what was baked in earlier ones.
  int stage = 0, stage_count = 1;
  std::vector<BakePlan> later;  ///< of the first stage: those after it, with what they are on standing as it starts

  bool is_last_stage() const { return stage + 1 == stage_count; }
  const Shot& shot() const { return inputs.shot; }
  /// First frame that is written; frames before it are pre-roll.
  int first_written() const { return shot().write_preroll ? shot().first_frame - shot().preroll : shot().first_frame; }
  int written_count() const { return shot().last_frame - first_written() + 1; }
};

using Importer = std::function<Result<ImportedPrimary>(const ImportRequest&)>;

/// The first stage, of most shots the only one. import_cache: folder for import results, may be empty.
Result<BakePlan> make_plan(BakeInputs inputs, const Importer& importer, const std::filesystem::path& import_cache);

/// The stage after `before`, in which its systems are bodies, too: `carriers` (carrier.h).
Result<BakePlan> plan_next_stage(const BakePlan& before, std::vector<PrimaryPlan> carriers);

}  // namespace ft::inline baker
