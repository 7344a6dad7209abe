#include "baker/commands/preview_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "baker/commands/base64.h"
#include "baker/commands/preview.h"
#include "baker/commands/preview_curves.h"
#include "baker/commands/preview_instances.h"
#include "baker/commands/preview_points.h"
#include "baker/core/edge_strain.h"
#include "baker/core/file.h"
#include "baker/core/parallel.h"
#include "baker/record/bake_folder.h"
#include "baker/record/cache_track.h"
#include "baker/record/primary_paths.h"
#include "baker/run/wind_file.h"
#include "baker/systems/interface/absent_runs.h"
#include "baker/systems/interface/system.h"
#include "collision/geometry/triangle_tree.h"

namespace ft::inline baker {
namespace {

constexpr double k_strain_step = 0.0025;  ///< of the 8-bit strain; player.js knows it as 40 steps to 10 %

/// A system on its way into the page.
struct Clip {
  ManifestSystem system;
  CacheTrack track;
  RestEdges rest_edges;
  Box box;
  std::vector<std::uint16_t> positions;
  std::vector<std::int8_t> strain;
  std::vector<std::uint8_t> gap;
  std::vector<std::vector<std::uint8_t>> scalars{};  ///< of its vertices, 0 to 1 in 255 steps
};

/// Positions go to 16 bits per axis between the clip's bounds.
Status quantise(Clip& clip, int frames) {
  std::vector<Vec3> x;
  for (int f = 0; f < frames; ++f) {
    x.clear();
    if (const Status read = clip.track.read(f, x); !read) return read;
    clip.box.include(bounds(x));
  }
  const Vec3 step = clip.box.size() / 65535.0;
  for (int f = 0; f < frames; ++f) {
    x.clear();
    if (const Status read = clip.track.read(f, x); !read) return read;
    for (const Vec3& p : x)
      for (int k = 0; k < 3; ++k)
        clip.positions.push_back(step[k] > 0
                                     ? static_cast<std::uint16_t>(std::lround((p[k] - clip.box.lo[k]) / step[k]))
                                     : std::uint16_t{0});
  }
  return {};
}

Status add_scalars(Clip& clip, int frames) {
  clip.scalars.resize(clip.track.reader->info().content.scalars.size());
  FrameData now;
  for (int f = 0; f < frames && !clip.scalars.empty(); ++f) {
    if (const Status read = clip.track.read(f, now); !read) return read;
    for (std::size_t n = 0; n < clip.scalars.size(); ++n)
      for (const float x : now.scalars[n])
        clip.scalars[n].push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0f, 1.0f))));
  }
  return {};
}

/// Per vertex the edge strain that is largest in size.
void add_strain(Clip& clip, std::span<const Vec3> x) {
  std::vector<double> worst(x.size(), 0.0);
  const std::vector<double> strains = edge_strains(clip.rest_edges, x);
  for (std::size_t e = 0; e < strains.size(); ++e)
    for (const int v : clip.rest_edges.edges[e])
      if (std::abs(strains[e]) > std::abs(worst[at(v)])) worst[at(v)] = strains[e];
  for (const double s : worst)
    clip.strain.push_back(static_cast<std::int8_t>(std::lround(std::clamp(s / k_strain_step, -127.0, 127.0))));
}

/// Distance to the nearest point of the surface, in 255 steps of the range.
void add_gap(Clip& clip, std::span<const Vec3> x, std::span<const Vec3> surface, std::span<const Triangle> triangles,
             const TriangleTree& tree) {
  const std::size_t first = clip.gap.size();
  clip.gap.resize(first + x.size());
  parallel_for(x.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      TriangleTree::Hit hit;
      hit.closest.squared_distance = k_preview_gap_range * k_preview_gap_range;
      tree.closest(x[i], surface, triangles, hit);
      clip.gap[first + i] =
          static_cast<std::uint8_t>(std::lround(255 * std::sqrt(hit.closest.squared_distance) / k_preview_gap_range));
    }
  });
}

/// Strain of what has it in the edges of its mesh, and the gap of all secondaries to what they must not pass: the
/// feasible collider, else the drawn body.
Status measure(std::vector<Clip>& clips, int frames) {
  for (Clip& clip : clips) {
    if (!is_secondary(clip.system.role) || clip.system.shape != OutputShape::k_mesh) continue;
    const SystemKind* kind = find_system_kind(clip.system.role);
    std::optional<RestEdges> rest = kind ? kind->rest_edges(clip.track) : std::nullopt;
    const bool strained = rest.has_value();
    if (rest) clip.rest_edges = std::move(*rest);
    const Clip* surface = nullptr;
    for (const Clip& other : clips)
      if (other.system.primary == clip.system.primary &&
          (other.system.role == "collider" || (other.system.role == "body" && surface == nullptr)))
        surface = &other;
    TriangleTree tree;
    std::vector<Vec3> x, y;
    for (int f = 0; f < frames; ++f) {
      x.clear();
      if (const Status read = clip.track.read(f, x); !read) return read;
      if (strained) add_strain(clip, x);
      if (surface == nullptr) continue;
      y.clear();
      if (const Status read = surface->track.read(f, y); !read) return read;
      if (tree.empty())
        tree = TriangleTree(y, surface->track.triangles);
      else
        tree.refit(y, surface->track.triangles);
      add_gap(clip, x, y, surface->track.triangles, tree);
    }
  }
  return {};
}

/// Of all strands of all systems the same share, so that no system loses more than another; 1: there is room for all.
double share_of_strands(const std::vector<Clip>& clips, int frames, double bytes) {
  double wanted = 0;
  for (const Clip& clip : clips)
    if (clip.system.shape == OutputShape::k_curves)
      wanted += static_cast<double>(preview_bytes_of_curves(clip.track, frames));
  return wanted > bytes ? bytes / wanted : 1;
}

Json describe(const Clip& clip) {
  const Vec3 step = clip.box.size() / 65535.0;
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : clip.track.triangles)
    for (const int v : t) corners.push_back(static_cast<std::uint32_t>(v));
  Json out{{"name", clip.system.name}, {"role", clip.system.role}, {"vertices", clip.track.rest.vertex_count()}};
  if (const SystemKind* kind = find_system_kind(clip.system.role)) {
    out["sheet"] = kind->is_sheet();
    if (kind->is_liquid()) out["liquid"] = true;
    out["colour"] = kind->colour();
  }
  out["low"] = {clip.box.lo[0], clip.box.lo[1], clip.box.lo[2]};
  out["step"] = {step[0], step[1], step[2]};
  out["triangles"] = base64_of(corners);
  out["positions"] = base64_of(clip.positions);
  for (std::size_t n = 0; n < clip.scalars.size(); ++n)
    out["scalars"][clip.track.reader->info().content.scalars[n]] = base64_of(clip.scalars[n]);
  if (!clip.strain.empty()) out["strain"] = base64_of(clip.strain);
  if (!clip.gap.empty()) out["gap"] = base64_of(clip.gap);
  return out;
}

/// Of each frame the vertices of a primary that some secondary on it does not meet, as first and count of each run;
/// null where they all are met in all frames. The drawn body's vertices are the feasible collider's first.
Json absent_rows(const Manifest& manifest, const ManifestSystem& primary, int frames) {
  Json out(at(frames), Json::array());
  bool any = false;
  for (const FrameReport& frame : manifest.frames) {
    const int index = frame.frame - manifest.first_written;
    if (index < 0 || index >= frames) continue;
    std::vector<char> marks(at(primary.vertex_count), 0);
    for (const AbsentRuns& runs : frame.absent) {
      const std::string& of = runs.collider.empty() ? runs.system : runs.collider;
      const auto is_its = [&](const ManifestSystem& s) { return s.name == of && s.primary == primary.primary; };
      if (std::none_of(manifest.systems.begin(), manifest.systems.end(), is_its)) continue;
      const std::vector<char> own = marks_of(runs, primary.vertex_count);
      std::transform(own.begin(), own.end(), marks.begin(), marks.begin(), std::bit_or<char>());
    }
    for (const auto& [first, count] : runs_of(primary.name, marks).runs) {
      out[at(index)].push_back(first);
      out[at(index)].push_back(count);
      any = true;
    }
  }
  return any ? out : Json(nullptr);
}

/// Milliseconds of each frame from report.json, where there is one.
std::map<int, double> milliseconds(const BakeFolder& folder) {
  std::map<int, double> out;
  const auto bytes = read_file(folder.report());
  if (!bytes) return out;
  const auto report =
      parse_json(std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()), folder.report().string());
  if (!report || !report->is_object() || !report->contains("frames") || !(*report)["frames"].is_array()) return out;
  for (const Json& row : (*report)["frames"])
    if (row.is_object() && row.contains("frame") && row["frame"].is_number_integer() && row.contains("milliseconds") &&
        row["milliseconds"].is_number())
      out[row["frame"].get<int>()] = row["milliseconds"].get<double>();
  return out;
}

Json frame_rows(const Manifest& manifest, const BakeFolder& folder, int frames) {
  const std::map<int, double> times = milliseconds(folder);
  Json rows = Json::array();
  for (const FrameReport& frame : manifest.frames) {
    if (frame.frame < manifest.first_written || frame.frame >= manifest.first_written + frames) continue;
    Json row = to_json(frame);
    row.erase("incidents");
    row.erase("absent");
    const auto time = times.find(frame.frame);
    row["milliseconds"] = time == times.end() ? Json(nullptr) : Json(time->second);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Whether a primary is a rigid prop: it has a shape, or cords, which no other may have.
bool has_prop(const Manifest& manifest) {
  for (const ManifestSystem& system : manifest.systems)
    if (const SystemKind* kind = find_system_kind(system.role); kind && kind->section().needs_rigid_primary())
      return true;
  return std::any_of(manifest.settings.begin(), manifest.settings.end(), [](const auto& setting) {
    return setting.first.starts_with("primary.") && setting.first.ends_with(".shape") && setting.second != "\"\"";
  });
}

/// Whether a primary is a set that stands still: a ground, or what cloth of others was solved with the drawn body of
/// for a collider.
bool stands(const Manifest& manifest, const std::string& primary) {
  if (std::ranges::any_of(manifest.systems, [&](const ManifestSystem& s) { return s.name == primary && s.sheet; }))
    return false;
  const auto shape =
      std::ranges::find(manifest.settings, "primary." + primary + ".shape", &Settings::value_type::first);
  if (shape != manifest.settings.end() && shape->second == fmt::format("\"{}\"", k_ground)) return true;
  return std::any_of(manifest.systems.begin(), manifest.systems.end(), [&](const ManifestSystem& cloth) {
    return cloth.primary != primary && std::find(cloth.meets.begin(), cloth.meets.end(), primary) != cloth.meets.end();
  });
}

Result<Json> path_rows(const std::filesystem::path& folder, const Manifest& manifest, int frames) {
  const auto paths = primary_paths(folder, manifest);
  if (!paths) return paths.error();
  Json out = Json::array();
  for (const PrimaryPath& path : *paths) {
    if (stands(manifest, path.primary)) continue;
    Json centres = Json::array();
    for (int f = 0; f < frames; ++f)
      centres.push_back({path.centres[at(f)].x(), path.centres[at(f)].y(), path.centres[at(f)].z()});
    out.push_back({{"name", path.primary}, {"centres", std::move(centres)}});
  }
  return out;
}

}  // namespace

Result<Json> preview_bake(const std::filesystem::path& bake_folder, double curve_bytes) {
  const BakeFolder folder{bake_folder};
  auto manifest = read_manifest(bake_folder);
  if (!manifest) return manifest.error();
  std::vector<Clip> clips;
  bool has_body = false;
  for (const ManifestSystem& system : manifest->systems) has_body = has_body || system.role == "body";
  int frames = manifest->written_count();
  for (const ManifestSystem& system : manifest->systems) {
    auto track = open_track(bake_folder, system, *manifest);
    if (!track) return track.error();
    if (system.shape == OutputShape::k_grid)
      return input_error(std::string("the page cannot show ") + std::string(shape_name(system.shape)) + " yet",
                         (bake_folder / system.caches[0].file).string());
    frames = std::min(frames, track->reader->info().frame_count);
    clips.push_back({system, std::move(*track), {}, {}, {}, {}, {}, {}});
  }
  if (clips.empty() || frames < 1) return input_error("the bake has no finished frame to show", bake_folder.string());
  if (const Status measured = measure(clips, frames); !measured) return measured.error();

  Json bake{{"shot", manifest->shot}, {"fps", manifest->fps},           {"first_frame", manifest->first_written},
            {"frame_count", frames},  {"complete", manifest->complete}, {"gap_range", k_preview_gap_range}};
  bake["prop"] = has_prop(*manifest);
  auto paths = path_rows(bake_folder, *manifest, frames);
  if (!paths) return paths.error();
  bake["paths"] = std::move(*paths);
  if (const auto file = std::ranges::find(manifest->files, k_wind_file, &ManifestFile::file);
      file != manifest->files.end()) {
    const auto text = read_text(bake_folder / k_wind_file, file->bytes);
    if (!text) return text.error();
    if (hash_bytes(std::as_bytes(std::span(*text))).hex() != file->content)
      return input_error("is not what its bake has written", (bake_folder / k_wind_file).string());
    bake["wind"] = Json::parse(*text);
  }
  bake["frames"] = frame_rows(*manifest, folder, frames);
  bake["metrics"] = Json::array();
  for (const Metric& metric : declared_metrics())
    bake["metrics"].push_back({{"key", metric.key}, {"unit", metric.unit}});
  bake["incidents"] = Json::array();
  for (const FrameReport& frame : manifest->frames)
    for (const Incident& i : frame.incidents)
      if (i.frame >= manifest->first_written && i.frame < manifest->first_written + frames)
        bake["incidents"].push_back(to_json(i));
  const double share = share_of_strands(clips, frames, curve_bytes);
  bake["systems"] = Json::array();
  for (Clip& clip : clips) {
    if (clip.system.role == "collider" && has_body) continue;  // looks like the body and costs as much
    if (clip.system.shape != OutputShape::k_mesh) {
      auto shown = clip.system.shape == OutputShape::k_curves   ? preview_curves(clip.system, clip.track, frames, share)
                   : clip.system.shape == OutputShape::k_points ? preview_points(clip.system, clip.track, frames)
                                                                : preview_instances(clip.system, clip.track, frames);
      if (!shown) return shown.error();
      if (const SystemKind* kind = find_system_kind(clip.system.role)) (*shown)["colour"] = kind->colour();
      bake["systems"].push_back(std::move(*shown));
      continue;
    }
    if (const Status done = quantise(clip, frames); !done) return done.error();
    if (const Status done = add_scalars(clip, frames); !done) return done.error();
    Json system = describe(clip);
    if (!is_secondary(clip.system.role)) system["absent"] = absent_rows(*manifest, clip.system, frames);
    // The body as drawn, where a secondary shows it as it is then; of several of them the last.
    const auto own = std::ranges::find(manifest->systems, clip.system.name, &ManifestSystem::name);
    const auto replaces = [&](const ManifestSystem& s) {
      const SystemKind* kind = find_system_kind(s.role);
      return kind && kind->shows_body() && s.primary == clip.system.primary;
    };
    if (clip.system.role == "body" || replaces(clip.system))
      system["hidden"] = clip.system.role == "body" ? std::ranges::any_of(manifest->systems, replaces)
                                                    : std::any_of(own + 1, manifest->systems.end(), replaces);
    if (clip.system.role == "body" && stands(*manifest, clip.system.name)) system["stands"] = true;
    bake["systems"].push_back(std::move(system));
  }
  return bake;
}

}  // namespace ft::inline baker
