// A kind of secondary: cloth, cords, what follows with a lag. Each is a folder beside this file and a line in
// registry.cpp, and nothing outside of its folder names it. The conductor knows kinds and their groups by these
// interfaces alone: the kind plans its sections of the shot file as groups of what is solved together, and judges their
// caches; a group has a solver.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "baker/core/bytes.h"
#include "baker/core/edge_strain.h"
#include "baker/core/mesh.h"
#include "baker/core/output_shape.h"
#include "baker/core/result.h"
#include "baker/systems/interface/collider_slice.h"
#include "io/shot/file_numbers.h"
#include "io/shot/shot.h"
#include "solvers/base/frame_metrics.h"
#include "solvers/base/solver.h"

namespace ft::inline baker {

struct BakePlan;
struct CacheTrack;
struct CachedBake;
struct Manifest;
struct ManifestSystem;
struct RoomReport;
struct StartReport;

/// How a secondary leaves: as a mesh in the vertex order of its file, whatever was joined for the simulation; or in the
/// shape that its solver has for it, too.
struct SystemOutput {
  std::size_t primary = 0;           ///< whom it is on, into BakePlan::primaries
  std::shared_ptr<const Mesh> mesh;  ///< the file's, placed; with the simulated triangles if the shot file wants those
  std::shared_ptr<const SystemShape> shape;  ///< in the place of the mesh, of what is none: Solver::system_shape()
  std::vector<int> joined_of;                ///< per vertex of the file: its vertex in the simulation; empty: the same
  double pattern_scale = 0;                  ///< of what is cut from a flat pattern: m per unit of its uvs; else 0
  double weld = 0;                           ///< what is nearer than this was joined [m]; 0: nothing
  FileNumbers in_file;                       ///< of the simulated mesh
  std::vector<std::string> scalars{};        ///< of a mesh: names of those of its vertices

  const std::string& name() const { return shape ? shape->name : mesh->name; }
  /// What formats are asked with.
  FrameContent content() const { return shape ? shape->content : FrameContent{.scalars = scalars}; }
  /// In one frame.
  FrameCounts counts() const;
};

/// A file beside the caches.
struct WrittenFile {
  std::string name;
  Bytes bytes;
};

/// Secondaries of one kind that are solved together, or a primary alone whose motion is cached.
class SystemGroup {
 public:
  explicit SystemGroup(std::size_t first_primary) : primary(first_primary) {}
  virtual ~SystemGroup() = default;

  std::size_t primary;                ///< into BakePlan::primaries: the first that has a secondary of the group
  std::vector<SystemOutput> outputs;  ///< one for each system of the solver

  /// Around its systems at the start [m]; empty: unknown.
  virtual Box start() const;
  /// Role of its systems in the manifest: the name of their kind.
  virtual std::string_view role() const = 0;
  /// Once: it takes what it needs out of the group.
  virtual Result<std::unique_ptr<Solver>> make_solver() = 0;
  /// What --dry-run says of it.
  virtual std::vector<std::string> lines(const BakePlan& plan) const = 0;

  /// Whether what it meets has a cache of its own, because it is not the body as drawn.
  virtual bool has_feasible_collider() const { return false; }
  /// Where it meets several primaries: the part of its collider that is each one's. taken: names that other groups'
  /// slices have; a second one of the same primary is called after the group's own, too.
  virtual std::vector<ColliderSlice> slices(const BakePlan& /*plan*/, std::span<const std::string> /*taken*/) const {
    return {};
  }
  /// What it writes beside its caches, before the first frame.
  virtual Result<std::vector<WrittenFile>> files(const BakePlan& /*plan*/, std::vector<std::string>& /*notes*/) const {
    return std::vector<WrittenFile>();
  }

  /// What is wrong where it starts, and where it has no room: appended.
  virtual void add_start(const BakePlan& /*plan*/, StartReport& /*report*/) const {}
  virtual void add_room(const BakePlan& /*plan*/, RoomReport& /*report*/) const {}
  /// The crossings of a state that no solver has reported on: added.
  virtual void add_certificate(const BakePlan& /*plan*/, const Solver& /*solver*/, const State& /*state*/,
                               FrameReport& /*report*/) const {}
};

using SystemGroups = std::vector<std::unique_ptr<SystemGroup>>;

/// Systems of a bake that are judged together, from their caches.
class JudgedGroup {
 public:
  virtual ~JudgedGroup() = default;
  /// index: of the frame in the caches, from 0. absent: what the bake says that its systems do not meet in this frame.
  virtual Result<FrameReport> judge(int index, int frame, std::span<const AbsentRuns> absent) const = 0;
  /// What cannot be judged.
  virtual std::vector<std::string> notes() const { return {}; }
};

class SystemKind {
 public:
  virtual ~SystemKind() = default;

  /// Its sections in the shot file.
  virtual const SecondarySection& section() const = 0;
  /// Of its sections, and of its systems in the manifest: "cloth".
  std::string_view name() const { return section().name(); }
  /// All its secondaries in a shot whose primaries are planned, in groups by their first primary. Notes go into the
  /// plan.
  virtual Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const = 0;
  /// Its systems in a finished bake, or in one that has come as far as its caches.
  virtual Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake& bake) const = 0;
  /// The lengths from which strain is measured, in the mesh of a cached system; none: its mesh's edges say nothing of
  /// it.
  virtual std::optional<RestEdges> rest_edges(const CacheTrack& /*track*/) const { return std::nullopt; }
  /// What it measures in each frame beside frame_metrics().
  virtual std::span<const Metric> metrics() const { return {}; }
  /// Whether its meshes are the body of the primary as it moves with it: seen in the place of the body as drawn.
  virtual bool shows_body() const { return false; }
  /// Whether its meshes are sheets, which are seen from both sides.
  virtual bool is_sheet() const { return false; }
  /// Whether its meshes are surfaces of a liquid, which mirrors and is looked through, and on which others may float.
  bool is_liquid() const { return section().is_liquid(); }
  /// In which the preview draws it, 0xrrggbb; 0: the next that no other has.
  virtual std::uint32_t colour() const { return 0; }
};

/// All kinds, in the order in which their systems stand in plans and manifests.
std::span<const SystemKind* const> system_kinds();
/// Adds a kind of a program that links the library, for as long as this stands. Its name is new. Not while anything
/// runs.
class AddedSystemKind {
 public:
  explicit AddedSystemKind(const SystemKind& kind);
  ~AddedSystemKind();
  AddedSystemKind(const AddedSystemKind&) = delete;
  AddedSystemKind& operator=(const AddedSystemKind&) = delete;

 private:
  const SystemKind* kind_;
};
/// The metrics of all kinds, beside frame_metrics().
std::span<const Metric> declared_metrics();
/// Among both; null: there is none of that name.
const Metric* find_metric(std::string_view key);
/// Null: no kind has that name.
const SystemKind* find_system_kind(std::string_view name);

}  // namespace ft::inline baker
