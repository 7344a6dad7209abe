// Judges cached garments: joined as they were simulated, against the feasible collider of each primary that they meet.
#include "baker/systems/cloth/cloth_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "baker/core/corner_uvs.h"
#include "baker/record/cache_track.h"
#include "baker/systems/interface/absent_runs.h"
#include "collision/check/crossings.h"
#include "collision/check/penetration.h"
#include "collision/check/sewn_pairs.h"
#include "io/shot/weld.h"
#include "solvers/cloth/model/sewing.h"

namespace ft::inline baker {
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
struct CachedCloths {
  std::vector<JudgedCloth> cloths;
  std::vector<CacheTrack> collider, body;  ///< one of each primary that it meets; none that is not cached
  std::vector<Triangle> cloth_triangles;
  RestEdges rest_edges;
  SewnPairs sewn;
  std::vector<int> first_vertex;

  std::size_t cloth_of(int vertex) const {
    const auto next = std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex);
    return static_cast<std::size_t>(next - first_vertex.begin()) - 1;
  }
};

void prepare(CachedCloths& group) {
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

void place_incident(const CachedCloths& group, int vertex, Incident& incident) {
  const std::size_t garment = group.cloth_of(vertex);
  incident.system = group.cloths[garment].track.name;
  incident.vertex = group.cloths[garment].in_file.vertex(vertex - group.first_vertex[garment]);
}

/// Of each cloth, a mark for every vertex of the collider that it does not meet; empty: it meets all.
std::vector<std::vector<char>> absent_for(const CachedCloths& group, std::span<const AbsentRuns> known,
                                          const std::string& collider, int count) {
  std::vector<std::vector<char>> out(group.cloths.size());
  for (std::size_t c = 0; c < out.size(); ++c)
    for (const AbsentRuns& runs : known)
      if (runs.system == group.cloths[c].track.name && (runs.collider.empty() || runs.collider == collider))
        out[c] = marks_of(runs, count);
  return out;
}

/// absent: what the bake says that its systems do not meet in this frame.
Result<FrameReport> judge_frame(const CachedCloths& group, std::span<const AbsentRuns> absent, int index, int frame) {
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
    if (body.sheet) continue;
    for (const Penetration& p : penetrations(x, y, body.triangles))
      if (p.depth > report.deepest_drawn) report.deepest_drawn = p.depth, worst = p.vertex;
    if (worst >= 0)
      incident(Incident::Kind::k_penetration, worst, report.deepest_drawn,
               fmt::format("{:.2f} mm inside the drawn body", 1e3 * report.deepest_drawn));
  }
  return report;
}

/// Of cloths that were solved with several primaries: "a.collider", "b" and so on.
std::string joint_name(const ManifestSystem& cloth) {
  std::string out;
  for (const std::string& name : cloth.meets) out += (out.empty() ? "" : ", ") + name;
  return out;
}

/// The colliders and the drawn bodies of all that a cloth meets, as far as they are cached.
Status add_met(const CachedBake& bake, const ManifestSystem& cloth, CachedCloths& group) {
  const auto is_met = [&](const ManifestSystem& s) {
    return std::find(cloth.meets.begin(), cloth.meets.end(), s.name) != cloth.meets.end();
  };
  const auto& systems = bake.manifest.systems;
  for (const ManifestSystem& system : systems) {
    bool collides = is_met(system), drawn = system.role == "body" && collides;
    drawn =
        drawn || (system.role == "body" && std::any_of(systems.begin(), systems.end(), [&](const ManifestSystem& s) {
                    return is_met(s) && s.primary == system.primary;
                  }));
    if (cloth.meets.empty() && system.primary == cloth.primary)
      collides = system.role == "collider", drawn = system.role == "body";
    for (const auto& [wanted, tracks] : {std::pair(collides, &group.collider), std::pair(drawn, &group.body)}) {
      if (!wanted || !bake.has_cache(system)) continue;
      auto track = bake.open(system);
      if (!track) return track.error();
      tracks->push_back(std::move(*track));
    }
  }
  return {};
}

class JudgedCloths final : public JudgedGroup {
 public:
  JudgedCloths(CachedCloths cloths, std::string where) : cloths_(std::move(cloths)), where_(std::move(where)) {}
  Result<FrameReport> judge(int index, int frame, std::span<const AbsentRuns> absent) const override {
    return judge_frame(cloths_, absent, index, frame);
  }
  std::vector<std::string> notes() const override {
    if (!cloths_.collider.empty()) return {};
    return {"the feasible collider of \"" + where_ + "\" is not cached: crossings with it are not judged"};
  }

 private:
  CachedCloths cloths_;
  std::string where_;
};

}  // namespace

RestEdges rest_edges_of(const Mesh& rest, std::span<const Triangle> triangles, double pattern_scale) {
  RestEdges out = rest_edges(rest.positions, triangles);
  if (!(pattern_scale > 0)) return out;
  const ClothPiece piece{0, rest.vertex_count(), Fabric{}, pattern_scale};
  lengths_from_pattern(
      make_cloth_topology(rest.positions, triangles, std::span(&piece, 1), corner_uvs(rest, triangles)), out);
  return out;
}

Result<std::vector<std::unique_ptr<JudgedGroup>>> judge_cloths(const CachedBake& bake) {
  std::map<std::string, CachedCloths> groups;
  for (const ManifestSystem& system : bake.manifest.systems) {
    if (system.role != "cloth" || !bake.has_cache(system)) continue;
    auto track = bake.open(system);
    if (!track) return track.error();
    const std::string where = system.meets.empty() ? system.primary : joint_name(system);
    CachedCloths& group = groups[where];
    if (group.cloths.empty())
      if (const Status added = add_met(bake, system, group); !added) return added.error();
    group.cloths.push_back(as_simulated(std::move(*track)));
  }
  std::vector<std::unique_ptr<JudgedGroup>> out;
  for (auto& [where, group] : groups) {
    prepare(group);
    out.push_back(std::make_unique<JudgedCloths>(std::move(group), where));
  }
  return out;
}

}  // namespace ft::inline baker
