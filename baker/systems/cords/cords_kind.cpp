#include "baker/systems/cords/cords_kind.h"

#include <fmt/format.h>

#include <limits>

#include "baker/record/cache_track.h"
#include "baker/systems/cords/cords_section.h"
#include "baker/systems/cords/judge_cords.h"
#include "baker/systems/cords/plan_cords.h"

namespace ft::inline baker {
namespace {

/// Cords and their prop, which is its own collider, as drawn.
class JudgedCords final : public JudgedGroup {
 public:
  JudgedCords(CacheTrack track, MiddleLines lines, std::vector<CacheTrack> bodies, std::string prop)
      : track_(std::move(track)), lines_(std::move(lines)), bodies_(std::move(bodies)), prop_(std::move(prop)) {}
  Result<FrameReport> judge(int index, int frame, std::span<const AbsentRuns> absent) const override;
  std::vector<std::string> notes() const override {
    if (!bodies_.empty()) return {};
    return {"the prop \"" + prop_ + "\" is not cached: crossings of cords with it are not judged"};
  }

 private:
  CacheTrack track_;
  MiddleLines lines_;
  std::vector<CacheTrack> bodies_;
  std::string prop_;
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
  for (const CacheTrack& body : bodies_) {
    std::vector<Vec3> y;
    if (const Status read = body.read(index, y); !read) return read.error();
    const CordsAndBody found = judge_cords(lines_.cords.edges, points, y, body.triangles);
    report.crossings_body = report.crossings_drawn = found.crossings;
    report.smallest_gap = found.gap;
    report.deepest_drawn = found.deepest;
    if (found.crossed >= 0)
      report.incidents.push_back({Incident::Kind::k_crossing, frame, track_.name, vertex_of_point(found.crossed),
                                  points[at(found.crossed)], 0,
                                  fmt::format("{} crossings of cords with the prop", found.crossings)});
    if (found.inside >= 0)
      report.incidents.push_back({Incident::Kind::k_penetration, frame, track_.name, vertex_of_point(found.inside),
                                  points[at(found.inside)], found.deepest,
                                  fmt::format("{:.2f} mm inside the prop", 1e3 * found.deepest)});
  }
  return report;
}

Result<std::unique_ptr<JudgedGroup>> judged(const CachedBake& bake, const ManifestSystem& system) {
  auto track = bake.open(system);
  if (!track) return track.error();
  auto lines = middle_lines(track->rest);
  if (!lines) return lines.error();
  std::vector<CacheTrack> bodies;
  for (const ManifestSystem& other : bake.manifest.systems) {
    if (other.role != "body" || other.primary != system.primary || !bake.has_cache(other)) continue;
    auto body = bake.open(other);
    if (!body) return body.error();
    bodies.push_back(std::move(*body));
  }
  return std::unique_ptr<JudgedGroup>(
      std::make_unique<JudgedCords>(std::move(*track), std::move(*lines), std::move(bodies), system.primary));
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
