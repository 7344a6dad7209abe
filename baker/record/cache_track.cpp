#include "baker/record/cache_track.h"

#include <fmt/format.h>

#include "baker/record/cached_instances.h"
#include "io/shot/mesh_file.h"

namespace ft::inline baker {

Status CacheTrack::read(int index, std::vector<Vec3>& out) const {
  std::vector<Vec3f> x;
  if (const Status done = reader->read_frame(index, x); !done) return done;
  for (const Vec3f& p : x) out.push_back(p.cast<double>());
  return {};
}

Status CacheTrack::read(int index, FrameData& out) const {
  if (const Status done = reader->read(index, out); !done) return done;
  const CacheInfo& info = reader->info();
  const Status sound = check_frame(out.view(), info, index, info.has_velocity);
  if (sound) return {};
  return input_error("the cache of \"" + name + "\": " + sound.error().what, sound.error().where);
}

Result<CacheTrack> open_track(const std::filesystem::path& folder, const ManifestSystem& system,
                              const Manifest& manifest) {
  if (system.caches.empty()) return input_error("system \"" + system.name + "\" has no cache", folder.string());
  const auto path = folder / system.caches[0].file;
  auto reader = system.shape == OutputShape::k_mesh ? open_cache(path) : open_cache_of_any_shape(path);
  if (!reader) return reader.error();
  CacheTrack track{.name = system.name,
                   .reader = std::move(*reader),
                   .pattern_scale = system.pattern_scale,
                   .sheet = system.sheet,
                   .weld = system.weld};
  const CacheInfo& info = track.reader->info();
  if (info.content.shape != system.shape)
    return input_error(
        fmt::format("holds {}, the manifest says {}", shape_name(info.content.shape), shape_name(system.shape)),
        path.string());
  if (!system.topology.empty()) {
    auto rest = read_obj(folder / system.topology);
    if (!rest) return rest.error();
    track.rest = std::move(*rest);
  }
  if (system.shape == OutputShape::k_instances)
    if (const Status added = add_instances(folder, system, track); !added) return added.error();
  if (system.shape == OutputShape::k_mesh && info.vertex_count != track.rest.vertex_count())
    return input_error(
        fmt::format("has {} vertices, {} has {}", info.vertex_count, system.topology, track.rest.vertex_count()),
        path.string());
  if (info.frame_count != manifest.written_count() && manifest.complete)
    return input_error(fmt::format("has {} frames, the manifest says {}", info.frame_count, manifest.written_count()),
                       path.string());
  track.triangles = triangulate(track.rest);
  if (track.pattern_scale > 0 && track.rest.uvs.empty())
    return input_error("has no vt, and the manifest says that the cloth is cut from its pattern",
                       (folder / system.topology).string());
  return track;
}

bool CachedBake::has_cache(const ManifestSystem& system) const {
  std::error_code error;
  return !system.caches.empty() && std::filesystem::exists(folder / system.caches[0].file, error);
}

}  // namespace ft::inline baker
