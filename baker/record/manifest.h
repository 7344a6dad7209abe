// manifest.json: what a bake is made of and what is promised of it. No times, hosts, paths or thread counts: the same
// bake gives the same bytes. Written when a bake begins, when it is interrupted, and when it is complete.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "baker/core/hash.h"
#include "baker/core/output_shape.h"
#include "baker/core/result.h"
#include "io/shot/shot.h"
#include "solvers/base/solver.h"

namespace ft::inline baker {

struct ManifestInput {
  std::string role, name, content;  ///< "cloth.dress.mesh", "dress.obj", 32 hex digits
};

struct ManifestCache {
  std::string format, file;
  std::uint64_t bytes = 0;  ///< 0 until the bake is complete
  std::string content;      ///< 32 hex digits; empty until the bake is complete
};

/// Whether a system of this role is what a solver moved, and not what it was moved by.
inline bool is_secondary(const std::string& role) {
  return role != "collider" && role != "body";
}

/// A mesh that instances are copies of.
struct ManifestPrototype {
  std::string name;
  int vertex_count = 0, face_count = 0;
};

struct ManifestSystem {
  std::string name;
  std::string role;     ///< "collider" (the feasible one), "body" (as drawn), or the name of its kind: "cloth"
  std::string primary;  ///< whom it belongs to
  int vertex_count = 0, face_count = 0;  ///< of a mesh
  std::string topology;  ///< OBJ of the rest shape, for formats that hold points only; of instances, of the prototypes
  std::vector<ManifestCache> caches;
  double pattern_scale = 0;  ///< of a cloth whose rest lengths are those of its flat pattern: m per unit of vt; else 0
  double weld = 0;  ///< what lay nearer than this at rest was one vertex for the simulation [m]; 0: nothing was joined
  /// Of a secondary that was solved with several primaries: the systems that are their colliders ("collider", or "body"
  /// where that is as drawn). Cloths with the same list were solved together. Empty: its primary's.
  std::vector<std::string> meets{};
  bool sheet = false;  ///< of a body: it has no inside
  OutputShape shape = OutputShape::k_mesh;
  int count = 0;        ///< of what is no mesh: its elements; 0: their number changes. Of curves all their vertices
  int curve_count = 0;  ///< of curves
  std::vector<std::string> scalars{};  ///< of a mesh: names of those of its vertices, in caches whose format has them
  std::vector<ManifestPrototype> prototypes{};  ///< of instances, in the order in which the topology's file has them
};

/// A file beside the caches, of an adjusted motion.
struct ManifestFile {
  std::string file;
  std::uint64_t bytes = 0;
  std::string content;  ///< 32 hex digits
};

struct Manifest {
  std::string version, build, fingerprint;
  std::string shot;  ///< name of the shot file
  bool complete = false;
  int first_frame = 1, last_frame = 1;  ///< of the shot
  int first_written = 1;                ///< of the caches; before first_frame when the pre-roll is written
  double fps = 24;
  int preroll = 0;  ///< frames
  std::vector<ManifestInput> inputs;
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<ManifestSystem> systems;
  std::vector<ManifestFile> files;
  std::vector<std::string> notes;
  std::vector<FrameReport> frames;  ///< pre-roll frames first; as far as the bake has come

  int written_count() const { return last_frame - first_written + 1; }
};

inline constexpr const char* k_manifest_name = "manifest.json";

std::string to_text(const Manifest& manifest);
Result<Manifest> manifest_from_text(const std::string& text, const std::string& where);
Result<Manifest> read_manifest(const std::filesystem::path& bake_folder);

/// Why a bake made of `before` is not the bake that is asked for now; empty: it is. One sentence each.
std::vector<std::string> stale_reasons(const Manifest& before, const Manifest& now);

/// The gates of the shot file, judged on the written frames.
struct Gates {
  double p99_strain = 0;  ///< 1; 0: off
  bool crossings = false;
  std::vector<std::pair<std::string, double>> most{};  ///< of metrics
};
Gates gates_of(const Shot& shot);
/// Error k_quality or k_diverged with the first frame that fails.
Status judge(const Manifest& manifest, const Gates& gates);

}  // namespace ft::inline baker
