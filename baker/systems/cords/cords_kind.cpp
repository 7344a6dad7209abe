#include "baker/systems/cords/cords_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "baker/record/cache_track.h"
#include "baker/record/met_bodies.h"
#include "baker/systems/cords/cords_section.h"
#include "baker/systems/cords/judge_cords.h"
#include "baker/systems/cords/plan_cords.h"

namespace ft::inline baker {
namespace {

/// Cords and what they meet, which is as drawn.
class JudgedCords final : public JudgedGroup {
 public:
  JudgedCords(CacheTrack track, MiddleLines lines, MetBodies met)
      : track_(std::move(track)), lines_(std::move(lines)), met_(std::move(met)) {}
  Result<FrameReport> judge(int index, int frame, std::span<const AbsentRuns> absent) const override;
  std::vector<std::string> notes() const override {
    std::vector<std::string> out;
    for (const std::string& name : met_.missing)
      out.push_back("\"" + name + "\" is not cached: crossings of cords with it are not judged");
    return out;
  }

 private:
  CacheTrack track_;
  MiddleLines lines_;
  MetBodies met_;
};

Result<FrameReport> JudgedCords::judge(int index, int frame, std::span<const AbsentRuns>) const {
  FrameReport report;
  report.frame = frame;
  report.smallest_gap = std::numeric_limits<double>::infinity();
  std::vector<Vec3> x, points;
  if (const Status read = track_.read(index, x); !read) return read.error();
  append_middle_points(x, points);
  report.finite = all_finite(x);
  const StrainSummary strain = summary(edge_strains(lines_.cords, points));
  report.strain_mean = strain.mean;
  report.strain_p99 = strain.p99;
  report.strain_max = strain.max;
  for (const CacheTrack& body : met_.bodies) {
    std::vector<Vec3> y;
    if (const Status read = body.read(index, y); !read) return read.error();
    const CordsAndBody found = judge_cords(lines_.cords.edges, points, y, body.triangles);
    report.crossings_body += found.crossings;
    report.crossings_drawn = report.crossings_body;
    report.smallest_gap = std::min(report.smallest_gap, found.gap);
    report.deepest_drawn = std::max(report.deepest_drawn, found.deepest);
    if (found.crossed >= 0)
      report.incidents.push_back({Incident::Kind::k_crossing, frame, track_.name, vertex_of_point(found.crossed),
                                  points[at(found.crossed)], 0,
                                  fmt::format("{} crossings of cords with \"{}\"", found.crossings, body.name)});
    if (found.inside >= 0)
      report.incidents.push_back({Incident::Kind::k_penetration, frame, track_.name, vertex_of_point(found.inside),
                                  points[at(found.inside)], found.deepest,
                                  fmt::format("{:.2f} mm inside \"{}\"", 1e3 * found.deepest, body.name)});
  }
  return report;
}

Result<std::unique_ptr<JudgedGroup>> judged(const CachedBake& bake, const ManifestSystem& system) {
  auto track = bake.open(system);
  if (!track) return track.error();
  auto lines = middle_lines(track->rest);
  if (!lines) return lines.error();
  auto met = met_bodies(bake, system);
  if (!met) return met.error();
  return std::unique_ptr<JudgedGroup>(
      std::make_unique<JudgedCords>(std::move(*track), std::move(*lines), std::move(*met)));
}

class CordsKind final : public SystemKind {
 public:
  const SecondarySection& section() const override { return cords_section(); }
  Result<SystemGroups> plan(const Shot& shot, BakePlan& plan) const override {
    SystemGroups out;
    for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
      auto group = cords_of(shot, p, plan);
      if (!group) return group.error();
      if (*group) out.push_back(std::move(*group));
    }
    return out;
  }
  Result<std::vector<std::unique_ptr<JudgedGroup>>> judge(const CachedBake& bake) const override {
    std::vector<std::unique_ptr<JudgedGroup>> out;
    for (const ManifestSystem& system : bake.manifest.systems) {
      if (system.role != name() || !bake.has_cache(system)) continue;
      auto one = judged(bake, system);
      if (!one) return one.error();
      out.push_back(std::move(*one));
    }
    return out;
  }
};

}  // namespace

const SystemKind* cords_kind() {
  static const CordsKind kind;
  return &kind;
}

}  // namespace ft::inline baker
