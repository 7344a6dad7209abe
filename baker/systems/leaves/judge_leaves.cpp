#include "baker/systems/leaves/judge_leaves.h"

#include <fmt/format.h>

#include <limits>

#include "baker/core/output_frame.h"
#include "baker/record/met_bodies.h"
#include "collision/check/crossings.h"

namespace ft::inline baker {
namespace {

class JudgedLeaves final : public JudgedGroup {
 public:
  JudgedLeaves(CacheTrack track, std::vector<int> prototypes, MetBodies met)
      : track_(std::move(track)), prototypes_(std::move(prototypes)), met_(std::move(met)) {
    for (const Mesh& prototype : track_.prototypes) triangles_of_.push_back(triangulate(prototype));
    int first = 0;
    for (const int p : prototypes_) {
      for (const Triangle& t : triangles_of_[at(p)]) triangles_.push_back({first + t[0], first + t[1], first + t[2]});
      first += track_.prototypes[at(p)].vertex_count();
    }
  }

  Result<FrameReport> judge(int index, int frame, std::span<const AbsentRuns>) const override {
    FrameData now;
    if (const Status read = track_.read(index, now); !read) return read.error();
    std::vector<Vec3> x;
    std::vector<int> leaf_of;
    for (std::size_t i = 0; i < prototypes_.size(); ++i)
      for (const Vec3& p : track_.prototypes[at(prototypes_[i])].positions) {
        const Vec3 scaled = p.cwiseProduct(now.scales[i].cast<double>());
        x.emplace_back(now.positions[i].cast<double>() + now.orientations[i].cast<double>() * scaled);
        leaf_of.push_back(static_cast<int>(i));
      }
    FrameReport report;
    report.frame = frame;
    report.smallest_gap = std::numeric_limits<double>::infinity();
    for (const CacheTrack& body : met_.bodies) {
      std::vector<Vec3> y;
      if (const Status read = body.read(index, y); !read) return read.error();
      const std::vector<Crossing> found = crossings_between(x, triangles_, y, body.triangles);
      report.crossings_body += static_cast<int>(found.size());
      report.crossings_drawn = report.crossings_body;
      if (found.empty()) continue;
      const int leaf = leaf_of[at(found[0].edge_of_first ? found[0].edge[0] : found[0].triangle[0])];
      report.incidents.push_back({Incident::Kind::k_crossing, frame, track_.name, leaf,
                                  now.positions[at(leaf)].cast<double>(), 0,
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
  std::vector<int> prototypes_;  ///< of each leaf
  MetBodies met_;
  std::vector<std::vector<Triangle>> triangles_of_;  ///< of the prototypes
  std::vector<Triangle> triangles_;                  ///< of all leaves, their vertices in turn
};

}  // namespace

Result<std::unique_ptr<JudgedGroup>> judged_leaves(const CachedBake& bake, const ManifestSystem& system) {
  auto track = bake.open(system);
  if (!track) return track.error();
  std::vector<int> prototypes = track->reader->info().instances.prototypes;
  auto met = met_bodies(bake, system);
  if (!met) return met.error();
  return std::unique_ptr<JudgedGroup>(
      std::make_unique<JudgedLeaves>(std::move(*track), std::move(prototypes), std::move(*met)));
}

}  // namespace ft::inline baker
