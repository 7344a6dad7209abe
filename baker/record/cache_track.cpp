#include "baker/record/cache_track.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

namespace {

/// What is wrong with the curves of a cache; empty: they are those of the manifest.
std::string fault_of_curves(const CacheInfo& info, const ManifestSystem& system) {
  if (info.curves.curve_count() == system.curve_count && info.vertex_count == system.count) return {};
  return fmt::format("has {} curves of {} vertices, the manifest says {} of {}", info.curves.curve_count(),
                     info.vertex_count, system.curve_count, system.count);
}

struct OpenedCache {
  std::filesystem::path path;
  std::unique_ptr<CacheReader> reader;
};

/// Whether the cache's format keeps all that the manifest says of scalars.
bool keeps_scalars(const ManifestCache& cache, const ManifestSystem& system) {
  const CacheFormat* format = find_cache_format(cache.format);
  return format && format->leaves_out({.shape = system.shape, .scalars = system.scalars}).empty();
}

/// The first of a system's caches that holds its shape, for a format may take curves and give their vertices alone, and
/// its scalars; where none does, the first that holds its shape, else the first.
Result<OpenedCache> open_cache_of(const std::filesystem::path& folder, const ManifestSystem& system) {
  OpenedCache first;
  bool first_fits = false;
  for (const ManifestCache& cache : system.caches) {
    const auto path = folder / cache.file;
    auto reader = system.shape == OutputShape::k_mesh ? open_cache(path) : open_cache_of_any_shape(path);
    if (!reader) return reader.error();
    const bool fits = (*reader)->info().content.shape == system.shape;
    if (fits && keeps_scalars(cache, system)) {
      if ((*reader)->info().content.scalars == system.scalars) return OpenedCache{path, std::move(*reader)};
      return input_error(
          fmt::format("has the scalars [{}], the manifest says [{}]",
                      fmt::join((*reader)->info().content.scalars, ", "), fmt::join(system.scalars, ", ")),
          path.string(), "put back the cache that this bake wrote, or bake anew");
    }
    if (!first.reader || (fits && !first_fits)) first = {path, std::move(*reader)}, first_fits = fits;
  }
  return first;
}

}  // namespace

Result<CacheTrack> open_track(const std::filesystem::path& folder, const ManifestSystem& system,
                              const Manifest& manifest) {
  if (system.caches.empty()) return input_error("system \"" + system.name + "\" has no cache", folder.string());
  auto opened = open_cache_of(folder, system);
  if (!opened) return opened.error();
  const std::filesystem::path& path = opened->path;
  CacheTrack track{.name = system.name,
                   .reader = std::move(opened->reader),
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
  if (system.shape == OutputShape::k_curves)
    if (std::string fault = fault_of_curves(info, system); !fault.empty())
      return input_error(std::move(fault), path.string());
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
