#include "baker/systems/leaves/judge_leaves.h"

#include <fmt/format.h>

#include <limits>

#include "baker/core/placed_instances.h"
#include "baker/record/met_bodies.h"
#include "collision/check/crossings.h"

namespace ft::inline baker {
namespace {

class JudgedLeaves final : public JudgedGroup {
 public:
  JudgedLeaves(CacheTrack track, MetBodies met) : track_(std::move(track)), met_(std::move(met)) {
    if (track_.shape() == OutputShape::k_instances) {
      prototypes_ = track_.reader->info().instances.prototypes;
      all_ = instances_as_mesh(track_.prototypes, prototypes_);
    } else {  // those that bend
      all_.triangles = track_.triangles;
      int count = 0;
      all_.instance_of_vertex = connected_pieces(track_.rest.vertex_count(), track_.triangles, count);
    }
  }

  Result<FrameReport> judge(int index, int frame, std::span<const AbsentRuns>) const override {
    FrameData now;
    if (const Status read = track_.read(index, now); !read) return read.error();
    std::vector<Vec3> x;
    if (prototypes_.empty())
      for (const Vec3f& p : now.positions) x.push_back(p.cast<double>());
    else
      x = placed(track_.prototypes, prototypes_, now);
    FrameReport report;
    report.frame = frame;
    report.smallest_gap = std::numeric_limits<double>::infinity();
    for (const CacheTrack& body : met_.bodies) {
      std::vector<Vec3> y;
      if (const Status read = body.read(index, y); !read) return read.error();
      const std::vector<Crossing> found = crossings_between(x, all_.triangles, y, body.triangles);
      report.crossings_body += static_cast<int>(found.size());
      report.crossings_drawn = report.crossings_body;
      if (found.empty()) continue;
      const int vertex = found[0].edge_of_first ? found[0].edge[0] : found[0].triangle[0];
      const int leaf = all_.instance_of_vertex[at(vertex)];
      report.incidents.push_back({Incident::Kind::k_crossing, frame, track_.name, leaf, x[at(vertex)], 0,
                                  fmt::format("{} crossings of leaves with \"{}\"", found.size(), body.name)});
    }
    return report;
  }
  std::vector<std::string> notes() const override {
    std::vector<std::string> out;
    for (const std::string& name : met_.missing)
      out.push_back("\"" + name + "\" is not cached: crossings of leaves with it are not judged");
    return out;
  }

 private:
  CacheTrack track_;
  std::vector<int> prototypes_;  ///< of each leaf; empty: a mesh
  MetBodies met_;
  PlacedInstances all_;
};

/// What of it has an inside or sides: leaves lie in the surface of liquids.
ManifestSystem without_liquids(const CachedBake& bake, ManifestSystem system) {
  for (const ManifestSystem& other : bake.manifest.systems)
    if (const SystemKind* kind = find_system_kind(other.role); kind && kind->is_liquid())
      std::erase(system.meets, other.role + "." + other.name);
  return system;
}

}  // namespace

Result<std::unique_ptr<JudgedGroup>> judged_leaves(const CachedBake& bake, const ManifestSystem& system) {
  auto track = bake.open(system);
  if (!track) return track.error();
  MetBodies bodies;
  const ManifestSystem solid = without_liquids(bake, system);
  if (system.meets.empty() || !solid.meets.empty()) {
    auto met = met_bodies(bake, solid);
    if (!met) return met.error();
    bodies = std::move(*met);
  }
  return std::unique_ptr<JudgedGroup>(std::make_unique<JudgedLeaves>(std::move(*track), std::move(bodies)));
}

}  // namespace ft::inline baker
