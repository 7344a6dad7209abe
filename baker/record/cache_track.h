// One system of a bake as its cache and topology file hold it, for everything that looks at bakes afterwards.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "baker/record/manifest.h"
#include "io/cache/cache.h"

namespace ft::inline baker {

struct CacheTrack {
  std::string name;
  std::unique_ptr<CacheReader> reader{};
  Mesh rest{};                        ///< from the topology file: rest shape, in the garment's own order [m]
  std::vector<Triangle> triangles{};  ///< of rest
  double pattern_scale = 0;           ///< m per unit of its uvs, which are the rest shape then; 0: the positions are
  bool sheet = false;                 ///< it has no inside
  double weld = 0;                 ///< what lies nearer than this at rest was joined for the simulation [m]; 0: nothing
  std::vector<Mesh> prototypes{};  ///< of instances, from the topology file; rest is all of them as one mesh then

  OutputShape shape() const { return reader->info().content.shape; }
  /// Appends the positions of a frame, counted from 0 [m].
  Status read(int index, std::vector<Vec3>& out) const;
  /// All of a frame. Error: it is not what the cache says that its frames hold, or not finite (k_input).
  Status read(int index, FrameData& out) const;
};

/// Opens the first cache of a system that holds its shape; refuses one whose shape, topology or number of frames is not
/// what the manifest says, curves whose numbers are not, and instances whose number, ids or prototypes are not.
Result<CacheTrack> open_track(const std::filesystem::path& folder, const ManifestSystem& system,
                              const Manifest& manifest);

/// A bake's folder as a kind sees it that judges its systems there.
struct CachedBake {
  const std::filesystem::path& folder;
  const Manifest& manifest;

  Result<CacheTrack> open(const ManifestSystem& system) const { return open_track(folder, system, manifest); }
  /// Whether the file is there that open() opens.
  bool has_cache(const ManifestSystem& system) const;
};

}  // namespace ft::inline baker
