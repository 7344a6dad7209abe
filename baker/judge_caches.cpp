#include "baker/judge_caches.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "baker/absent_runs.h"
#include "baker/cache_track.h"
#include "baker/core/edge_strain.h"
#include "baker/judge_cords.h"
#include "baker/report_json.h"
#include "collision/crossings.h"
#include "collision/penetration.h"
#include "collision/sewn_pairs.h"
#include "io/shot/weld.h"

namespace ft {
namespace {

/// A cloth as it was simulated: vertices that its bake joined are one.
struct JudgedCloth {
  CacheTrack track;
  Mesh mesh;  ///< at rest
  FileNumbers in_file;
  std::vector<Triangle> triangles;

  /// Appends the positions of a frame, counted from 0 [m].
  Status read(int index, std::vector<Vec3>& out) const;
};

Status JudgedCloth::read(int index, std::vector<Vec3>& out) const {
  if (!(track.weld > 0)) return track.read(index, out);
  std::vector<Vec3> in_file_order;
  if (const Status read = track.read(index, in_file_order); !read) return read;
  for (int v = 0; v < mesh.vertex_count(); ++v) out.push_back(in_file_order[at(in_file.vertex(v))]);
  return {};
}

JudgedCloth as_simulated(CacheTrack track) {
  JudgedCloth out;
  out.mesh = track.rest;
  if (track.weld > 0) {
    WeldedMesh welded = weld(track.rest, track.weld);
    out.mesh = std::move(welded.mesh);
    out.in_file = std::move(welded.in_file);
  }
  out.triangles = triangulate(out.mesh);
  out.track = std::move(track);
  return out;
}

/// What was solved together.
struct Group {
  std::vector<JudgedCloth> cloths;
  std::vector<CacheTrack> collider, body;  ///< one of each primary that it meets; none that is not cached
  std::vector<Triangle> cloth_triangles;
  RestEdges rest_edges;
  SewnPairs sewn;
  std::vector<int> first_vertex;
  std::vector<CacheTrack> cords;
  std::vector<MiddleLines> lines;  ///< of each of them

  std::size_t cloth_of(int vertex) const {
    const auto next = std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex);
    return static_cast<std::size_t>(next - first_vertex.begin()) - 1;
  }
};

void prepare(Group& group) {
  int first = 0;
  std::vector<Stitch> stitches;
  for (const JudgedCloth& cloth : group.cloths) {
    group.first_vertex.push_back(first);
    for (const Triangle& t : cloth.triangles)
      group.cloth_triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    for (Stitch s : cloth.mesh.stitches) {
      s.vertex += first, s.edge[0] += first, s.edge[1] += first;
      stitches.push_back(s);
    }
    const RestEdges own = rest_edges_of(cloth.mesh, cloth.triangles, cloth.track.pattern_scale);
    for (const Edge& e : own.edges) group.rest_edges.edges.push_back({e[0] + first, e[1] + first});
    group.rest_edges.lengths.insert(group.rest_edges.lengths.end(), own.lengths.begin(), own.lengths.end());
    first += cloth.mesh.vertex_count();
  }
  group.first_vertex.push_back(first);
  group.sewn = SewnPairs(first, stitches, group.cloth_triangles);
}

void place_incident(const Group& group, int vertex, Incident& incident) {
  const std::size_t garment = group.cloth_of(vertex);
  incident.system = group.cloths[garment].track.name;
  incident.vertex = group.cloths[garment].in_file.vertex(vertex - group.first_vertex[garment]);
}

/// Of each cloth, a mark for every vertex of the collider that it does not meet; empty: it meets all.
std::vector<std::vector<char>> absent_for(const Group& group, const std::vector<AbsentRuns>& known,
                                          const std::string& collider, int count) {
  std::vector<std::vector<char>> out(group.cloths.size());
  for (std::size_t c = 0; c < out.size(); ++c)
    for (const AbsentRuns& runs : known)
      if (runs.system == group.cloths[c].track.name && (runs.collider.empty() || runs.collider == collider))
        out[c] = marks_of(runs, count);
  return out;
}

/// absent: what the bake says that its systems do not meet in this frame.
Result<FrameReport> judge_frame(const Group& group, const std::vector<AbsentRuns>& absent, int index, int frame) {
  FrameReport report;
  report.frame = frame;
  report.smallest_gap = std::numeric_limits<double>::infinity();
  std::vector<Vec3> x;
  for (const JudgedCloth& cloth : group.cloths)
    if (const Status read = cloth.read(index, x); !read) return read.error();
  report.finite = all_finite(x);
  const auto incident = [&](Incident::Kind kind, int vertex, double depth, std::string text) {
    Incident out;
    out.kind = kind;
    out.frame = frame;
    out.place = x[static_cast<std::size_t>(vertex)];
    out.depth = depth;
    out.text = std::move(text);
    place_incident(group, vertex, out);
    report.incidents.push_back(std::move(out));
  };
  const StrainSummary strain = summary(edge_strains(group.rest_edges, x));
  report.strain_mean = strain.mean;
  report.strain_p99 = strain.p99;
  report.strain_max = strain.max;
  for (const CacheTrack& collider : group.collider) {
    std::vector<Vec3> y;
    if (const Status read = collider.read(index, y); !read) return read.error();
    auto crossings = crossings_between(x, group.cloth_triangles, y, collider.triangles);
    const auto marks = absent_for(group, absent, collider.name, static_cast<int>(y.size()));
    int most = 0;
    for (const std::vector<char>& own : marks)
      most = std::max(most, static_cast<int>(std::count(own.begin(), own.end(), char{1})));
    report.absent_vertices += most;
    report.crossings_absent += static_cast<int>(std::erase_if(crossings, [&](const Crossing& c) {
      return second_is_marked(c, marks[group.cloth_of(c.edge_of_first ? c.edge[0] : c.triangle[0])]);
    }));
    report.crossings_body += static_cast<int>(crossings.size());
    if (!crossings.empty())
      incident(Incident::Kind::k_crossing, crossings[0].edge_of_first ? crossings[0].edge[0] : crossings[0].triangle[0],
               0, fmt::format("{} crossings with the feasible collider", crossings.size()));
  }
  auto own = crossings_within(x, group.cloth_triangles);
  std::erase_if(own, [&](const Crossing& c) { return group.sewn.together(c); });
  report.crossings_self = static_cast<int>(own.size());
  if (!own.empty())
    incident(Incident::Kind::k_crossing, own[0].edge[0], 0, fmt::format("{} crossings among cloths", own.size()));
  for (const CacheTrack& body : group.body) {
    std::vector<Vec3> y;
    if (const Status read = body.read(index, y); !read) return read.error();
    report.crossings_drawn += static_cast<int>(crossings_between(x, group.cloth_triangles, y, body.triangles).size());
    int worst = -1;
    for (const Penetration& p : penetrations(x, y, body.triangles))
      if (p.depth > report.deepest_drawn) report.deepest_drawn = p.depth, worst = p.vertex;
    if (worst >= 0)
      incident(Incident::Kind::k_penetration, worst, report.deepest_drawn,
               fmt::format("{:.2f} mm inside the drawn body", 1e3 * report.deepest_drawn));
  }
  return report;
}

/// Whether the file is there that open_track() opens.
bool has_cache(const std::filesystem::path& folder, const ManifestSystem& system) {
  std::error_code error;
  return !system.caches.empty() && std::filesystem::exists(folder / system.caches[0].file, error);
}

/// Of cloths that were solved with several primaries: "a.collider", "b" and so on.
std::string joint_name(const ManifestSystem& cloth) {
  std::string out;
  for (const std::string& name : cloth.meets) out += (out.empty() ? "" : ", ") + name;
  return out;
}

/// The colliders and the drawn bodies of all that a cloth meets, as far as they are cached.
Status add_met(const std::filesystem::path& folder, const Manifest& manifest, const ManifestSystem& cloth,
               Group& group) {
  const auto is_met = [&](const ManifestSystem& s) {
    return std::find(cloth.meets.begin(), cloth.meets.end(), s.name) != cloth.meets.end();
  };
  for (const ManifestSystem& system : manifest.systems) {
    const bool collides = is_met(system),
               drawn = system.role == "body" &&
                       (collides ||
                        std::any_of(manifest.systems.begin(), manifest.systems.end(),
                                    [&](const ManifestSystem&s) { return is_met(s) && s.primary == system.primary; }));
    for (const auto& [wanted, tracks] : {std::pair(collides, &group.collider), std::pair(drawn, &group.body)}) {
      if (!wanted || !has_cache(folder, system)) continue;
      auto track = open_track(folder, system, manifest);
      if (!track) return track.error();
      tracks->push_back(std::move(*track));
    }
  }
  return {};
}

/// A prop is its own collider, as drawn.
Result<FrameReport> judge_cords_in_frame(const Group& group, std::size_t cords, int index, int frame) {
  const CacheTrack& track = group.cords[cords];
  const MiddleLines& lines = group.lines[cords];
  FrameReport report;
  report.frame = frame;
  report.smallest_gap = std::numeric_limits<double>::infinity();
  std::vector<Vec3> x, points;
  if (const Status read = track.read(index, x); !read) return read.error();
  append_middle_points(x, points);
  report.finite = all_finite(x);
  const StrainSummary strain = summary(edge_strains(lines.cords, points));
  report.strain_mean = strain.mean;
  report.strain_p99 = strain.p99;
  report.strain_max = strain.max;
  for (const CacheTrack& body : group.body) {
    std::vector<Vec3> y;
    if (const Status read = body.read(index, y); !read) return read.error();
    const CordsAndBody found = judge_cords(lines.cords.edges, points, y, body.triangles);
    report.crossings_body = report.crossings_drawn = found.crossings;
    report.smallest_gap = found.gap;
    report.deepest_drawn = found.deepest;
    if (found.crossed >= 0)
      report.incidents.push_back({Incident::Kind::k_crossing, frame, track.name, vertex_of_point(found.crossed),
                                  points[at(found.crossed)], 0,
                                  fmt::format("{} crossings of cords with the prop", found.crossings)});
    if (found.inside >= 0)
      report.incidents.push_back({Incident::Kind::k_penetration, frame, track.name, vertex_of_point(found.inside),
                                  points[at(found.inside)], found.deepest,
                                  fmt::format("{:.2f} mm inside the prop", 1e3 * found.deepest)});
  }
  return report;
}

}  // namespace

Result<CacheJudgement> judge_caches(const std::filesystem::path& bake_folder) {
  auto manifest = read_manifest(bake_folder);
  if (!manifest) return manifest.error();
  CacheJudgement out;
  out.shot = manifest->shot;
  out.complete = manifest->complete;
  int frames = manifest->written_count();
  std::map<std::string, Group> groups;
  for (const ManifestSystem& system : manifest->systems) {
    if (!manifest->complete && !has_cache(bake_folder, system)) {
      frames = 0;
      continue;
    }
    auto track = open_track(bake_folder, system, *manifest);
    if (!track) return track.error();
    Group& group = groups[system.meets.empty() ? system.primary : joint_name(system)];
    if (system.role == "cords") {
      auto lines = middle_lines(track->rest);
      if (!lines) return lines.error();
      group.lines.push_back(std::move(*lines));
    }
    if (system.role == "cloth") {
      group.cloths.push_back(as_simulated(std::move(*track)));
      continue;
    }
    (system.role == "cords"      ? group.cords
     : system.role == "collider" ? group.collider
                                 : group.body)
        .push_back(std::move(*track));
  }
  for (const ManifestSystem& system : manifest->systems) {
    if (system.meets.empty()) continue;
    const auto group = groups.find(joint_name(system));
    if (group == groups.end() || !group->second.collider.empty() || !group->second.body.empty()) continue;
    if (const Status added = add_met(bake_folder, *manifest, system, group->second); !added) return added.error();
  }
  if (groups.empty()) frames = 0;
  for (auto& [primary, group] : groups) {
    prepare(group);
    out.has_collider = out.has_collider || !group.collider.empty();
    out.has_body = out.has_body || !group.body.empty();
    out.has_cords = out.has_cords || !group.cords.empty();
    if (!group.cords.empty() && group.body.empty())
      out.notes.push_back("the prop \"" + primary + "\" is not cached: crossings of cords with it are not judged");
    if (!group.cloths.empty() && group.collider.empty())
      out.notes.push_back("the feasible collider of \"" + primary +
                          "\" is not cached: crossings with it are not judged");
    for (const JudgedCloth& cloth : group.cloths) frames = std::min(frames, cloth.track.reader->info().frame_count);
    for (const auto* tracks : {&group.cords, &group.collider, &group.body})
      for (const CacheTrack& track : *tracks) frames = std::min(frames, track.reader->info().frame_count);
  }
  out.frame_count = manifest->written_count();
  out.missing_frames = out.frame_count - frames;
  std::map<int, const std::vector<AbsentRuns>*> absent;
  for (const FrameReport& frame : manifest->frames) absent[frame.frame] = &frame.absent;
  const std::vector<AbsentRuns> none;
  for (int i = 0; i < frames; ++i) {
    const auto known = absent.find(manifest->first_written + i);
    bool first = true;
    FrameReport all;
    const auto add = [&](const Result<FrameReport>& report) -> Status {
      if (!report) return report.error();
      all = first ? *report : merge(all, *report);
      first = false;
      return {};
    };
    for (const auto& [primary, group] : groups) {
      if (!group.cloths.empty())
        if (const Status judged =
                add(judge_frame(group, known == absent.end() ? none : *known->second, i, manifest->first_written + i));
            !judged)
          return judged.error();
      for (std::size_t c = 0; c < group.cords.size(); ++c)
        if (const Status judged = add(judge_cords_in_frame(group, c, i, manifest->first_written + i)); !judged)
          return judged.error();
    }
    if (!first) out.frames.push_back(std::move(all));
  }
  return out;
}

}  // namespace ft
