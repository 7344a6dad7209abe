#include "io/import/import_geometry_cache.h"

#include <cmath>

#include "io/import/character/clips.h"
#include "io/import/files/read_geometry_cache.h"
#include "io/import/motion/placement.h"
#include "io/import/motion/sampled_trajectory.h"
#include "io/import/motion/sheet.h"
#include "io/import/repair/facing.h"
#include "io/import/repair/stray_vertices.h"

namespace ft::inline io {
namespace {

/// Its faces then point outwards in the pose of its first sample; linear: file units to metres.
void turn_cache_outwards(GeometryCache& cache, const Mat3& linear, std::vector<std::string>& notes) {
  std::vector<Vec3> positions;
  for (const Vec3f& p : cache.sample(0)) positions.push_back(linear * p.cast<double>());
  std::vector<Triangle> triangles = triangulate(cache.mesh);
  const std::vector<Triangle> before = triangles;
  for (std::string& note : turn_outwards(positions, triangles).notes()) notes.push_back(std::move(note));
  if (triangles == before) return;
  cache.mesh = make_triangle_mesh(cache.mesh.name, std::move(cache.mesh.positions), triangles);
}

/// Whether it is one in its first sample, if the request says nothing of it.
bool is_sheet(const GeometryCache& cache, const Mat3& linear, const std::string& surface,
              std::vector<std::string>& notes) {
  if (!surface.empty()) return surface == "sheet";
  std::vector<Vec3> positions;
  for (const Vec3f& p : cache.sample(0)) positions.push_back(linear * p.cast<double>());
  const Openings openings = openings_of(positions, triangulate(cache.mesh));
  const bool out = openings.share() >= k_sheet_share;
  if (std::string note = openings_note(openings, out); !note.empty()) notes.push_back(std::move(note));
  return out;
}

}  // namespace

Result<ImportedPrimary> import_geometry_cache(const ImportRequest& request) {
  const double fps = request.source_fps > 0 ? request.source_fps : knows_its_times(request.file) ? 0 : request.shot_fps;
  auto cache = read_geometry_cache(request.file, request.topology, fps);
  if (!cache) return cache.error();
  const std::string name = request.file.string();
  auto axes = axes_from_up(request.up.empty() ? "y" : request.up);
  if (!axes) return axes.error();
  Placement placement;
  placement.unit_given = request.unit_scale > 0;
  placement.unit_scale = placement.unit_given ? request.unit_scale : 1;
  placement.axes = *axes, placement.up = request.up.empty() ? "y" : request.up;

  Box box;
  for (const Vec3f& p : cache->sample(0)) box.include(Vec3(placement.unit_scale * placement.axes * p.cast<double>()));
  const double measured = box.size().y();
  if (request.height > 0 && measured > 0) {
    const double factor = request.height / measured;
    placement.unit_scale *= factor;
    box.lo *= factor, box.hi *= factor;
  } else if (!placement.unit_given && cache->times.size() > 1) {  // a prop may have any size
    if (Status s = check_height(measured, placement, name); !s) return s.error();
  }
  const Mat3 linear = placement.unit_scale * placement.axes;
  const Clip whole{.name = cache->format, .start = 0, .end = cache->times.back()};
  if (Status s = check_clip_range(whole, request, name); !s) return s.error();

  ImportedPrimary out;
  out.content = cache->content;
  out.info.notes = cache->notes;
  turn_cache_outwards(*cache, linear, out.info.notes);
  out.info.format = cache->format;
  out.info.vertex_count = cache->vertex_count;
  out.info.unit_scale = placement.unit_scale, out.info.up = placement.up;
  out.info.bind_bounds = box;
  out.info.clips.push_back({"samples", 0, cache->times.back(), static_cast<int>(cache->times.size())});
  out.info.mesh_names.push_back(cache->mesh.name);
  if (cache->times.size() == 1 && request.duration > 0) {
    out.info.still = true;
    out.info.notes.push_back(cache->format == "OBJ" ? "is one OBJ and no numbered sequence: it stands still"
                                                    : "holds one sample: it stands still");
  }
  const auto frame_of = [&](int sample) {
    const double time = cache->times[static_cast<std::size_t>(sample)] - request.clip_start;
    return request.first_frame + std::round(100 * time / request.speed * request.shot_fps) / 100;
  };
  for (std::string& note : stray_notes(cache->strays, request.file.filename().string(), placement.unit_scale, frame_of))
    out.info.notes.push_back(std::move(note));
  const bool sheet = is_sheet(*cache, linear, request.surface, out.info.notes);
  auto trajectory = std::make_unique<SampledTrajectory>(
      std::move(*cache), placement.axes, placement.unit_scale,
      Playback{request.clip_start, request.speed, request.preroll, request.clip_bind, request.loop}, sheet);
  if (const Cycle& cycle = trajectory->cycle(); cycle.period > 0) {
    const CycleSpan span = cycles_of_shot(cycle, request);
    out.info.notes.push_back(cycle_note(cycle, span, box.size().maxCoeff()));
    out.info.seam_frames = span.seam_frames;
  }
  out.trajectory = std::move(trajectory);
  out.info.triangle_count = static_cast<int>(out.trajectory->surface().triangles.size());
  return out;
}

}  // namespace ft::inline io
