// All caches of one bake: every secondary in every format that takes its shape, the feasible collider and the drawn
// body of each primary in the first format. The walk takes a snapshot of a frame; the writer thread writes it.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "baker/plan/plan.h"
#include "baker/record/manifest.h"
#include "io/cache/cache.h"
#include "solvers/base/has_scalars.h"
#include "solvers/base/moves_primaries.h"

namespace ft::inline baker {

using Solvers = std::vector<std::unique_ptr<Solver>>;

/// Every cached system at one frame, as the files will have it; of meshes the positions [m].
struct Snapshot {
  int frame = 0;
  std::vector<FrameData> systems;
};

class CacheSet {
 public:
  /// earlier: systems of earlier stages, whose names are taken.
  CacheSet(const BakePlan& plan, const Solvers& solvers, std::filesystem::path folder,
           std::vector<ManifestSystem> earlier = {});

  /// Once. last_kept: last frame that files of an interrupted bake keep. Files that keep none are new, and so is the
  /// OBJ of each system beside them.
  Status open(int last_kept);
  Snapshot take(std::span<const State> states) const;
  /// What a group's systems do not meet, in the numbers of the cached colliders.
  std::vector<AbsentRuns> as_cached(std::size_t group, std::vector<AbsentRuns> absent) const;
  /// Frames of the pre-roll go where all are recorded, and into caches if the shot says so. before, after: snapshots of
  /// the frames beside it, for the velocities of what moves by itself: central differences, one-sided ones where one is
  /// null, zero where both are.
  Status write(const Snapshot& snapshot, const Snapshot* before, const Snapshot* after);
  /// Of a snapshot what write() needs as `before`: see Checkpoint.
  std::vector<std::vector<float>> to_numbers(const Snapshot& before) const;
  /// Back again; null where the numbers are not those of these systems.
  std::shared_ptr<const Snapshot> from_numbers(int frame, const std::vector<std::vector<float>>& numbers) const;
  Status close();

  /// For the manifest, with those of earlier stages in front; sizes and content hashes once close() has succeeded.
  std::vector<ManifestSystem> systems() const;
  /// Estimate for all frames [bytes].
  std::uint64_t expected_bytes() const;

 private:
  struct Source {
    std::size_t group = 0;
    int garment = -1;  ///< -1: the collider or the body
    bool collider = false;
    std::size_t primary = 0;                     ///< whom it belongs to
    const MovesPrimaries* mover = nullptr;       ///< of a body that goes where the group's solver takes it; else null
    std::vector<int> slice{};                    ///< of the collider's vertices; empty: all
    std::shared_ptr<const Mesh> mesh{};          ///< rest shape; null once the files have it
    std::shared_ptr<const SystemShape> shape{};  ///< of what is no mesh
    FrameContent content{};                      ///< what its frames hold
    const HasScalars* scalars = nullptr;         ///< whose; null: its vertices have none
    bool flows = false;  ///< it is a liquid's surface: what flows at its vertices is added to how they move
  };
  /// Of a mesh.
  std::vector<Vec3> positions_of_mesh(std::size_t system, const State& state) const;
  /// Of a garment, in the order of its file.
  void positions_of(const Source& source, const State& state, std::span<Vec3> x) const;
  /// Of a garment at `frame` [m/s]; before, after: in the frames beside it, empty where not known.
  std::vector<Vec3> velocities_of(const Source& source, int frame, std::span<const Vec3> x,
                                  std::span<const Vec3f> before, std::span<const Vec3f> after) const;
  /// Whether its velocities are differences of its positions.
  bool has_differences(std::size_t system) const { return sources_[system].garment >= 0 && !sources_[system].shape; }
  void slice_of(const Source& source, const State& state, std::span<Vec3> x) const;
  void add_collider(std::size_t group, const ColliderSlice& slice, std::span<const Vec3> collider);
  void add_body(std::size_t group, std::size_t primary);
  std::vector<std::string> names() const;
  CacheInfo info_of(std::size_t system) const;
  Status write_rest(std::size_t system) const;
  void add(Source source, std::string name, const std::string& role, bool all_formats);
  int begin() const { return plan_.shot().first_frame - plan_.shot().preroll; }
  Status open_motion(std::size_t system, const CacheInfo& info, int keep_frames);

  const BakePlan& plan_;
  const Solvers& solvers_;
  std::filesystem::path folder_;
  std::vector<std::vector<ColliderSlice>> slices_;  ///< per group; empty without a joint body
  std::vector<Source> sources_;
  std::vector<ManifestSystem> systems_;
  std::vector<ManifestSystem> earlier_;
  std::vector<std::vector<std::unique_ptr<CacheWriter>>> writers_;
  /// Per system: of its motion in all frames, for later stages; null: none needs it.
  std::vector<std::unique_ptr<CacheWriter>> motions_;
  std::vector<std::unique_ptr<CacheWriter>> flows_;  ///< and of liquids how they flow
};

}  // namespace ft::inline baker
