#include "baker/systems/hair/judge_hair.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "baker/record/met_bodies.h"
#include "collision/check/crossings.h"
#include "collision/check/penetration.h"

namespace ft::inline baker {
namespace {

/// Of a segment's ends, inside of a body: less is what caches round, and what skin is refined by [m].
constexpr double k_deep = 1e-4;

class JudgedHair final : public JudgedGroup {
 public:
  JudgedHair(CacheTrack track, MetBodies met) : track_(std::move(track)), met_(std::move(met)) {
    const CurveSet& curves = track_.reader->info().curves;
    int first = 0;
    for (const int count : curves.vertices_per_curve) {
      first_.push_back(first);
      first += count;
    }
    first_.push_back(first);
    std::vector<Vec3> start;
    combed_.assign(at(first_.back()), 0.0);
    if (!track_.read(0, start)) return;
    for (std::size_t s = 0; s + 1 < first_.size(); ++s) rest_.push_back(length(start, s));
    for (const CacheTrack& body : met_.bodies) {
      std::vector<Vec3> y;
      if (body.sheet || !body.read(0, y)) continue;
      for (const Penetration& p : penetrations(start, y, body.triangles, 0))
        combed_[at(p.vertex)] = std::max(combed_[at(p.vertex)], p.depth);
    }
  }

  Result<FrameReport> judge(int index, int frame, std::span<const AbsentRuns>) const override {
    FrameData now;
    if (const Status read = track_.read(index, now); !read) return read.error();
    std::vector<Vec3> x;
    for (const Vec3f& p : now.positions) x.push_back(p.cast<double>());
    FrameReport report;
    report.frame = frame;
    report.smallest_gap = std::numeric_limits<double>::infinity();
    std::vector<double> off;
    for (std::size_t s = 0; s < rest_.size(); ++s) off.push_back(std::abs(length(x, s) / rest_[s] - 1));
    std::sort(off.begin(), off.end());
    if (!off.empty()) {
      report.strain_max = off.back();
      report.strain_p99 = off[(off.size() - 1) * 99 / 100];
    }
    for (const CacheTrack& body : met_.bodies) {
      if (body.sheet) continue;
      std::vector<Vec3> y;
      if (const Status read = body.read(index, y); !read) return read.error();
      for (const Penetration& p : penetrations(x, y, body.triangles, k_deep)) {
        if (p.depth < combed_[at(p.vertex)] + k_deep) continue;
        ++report.inside_body;
        if (p.depth <= report.deepest_drawn) continue;
        report.deepest_drawn = p.depth;
        report.incidents.assign(1, {Incident::Kind::k_penetration, frame, track_.name, strand_of(p.vertex),
                                    x[at(p.vertex)], p.depth, fmt::format("a strand is inside \"{}\"", body.name)});
      }
    }
    return report;
  }
  std::vector<std::string> notes() const override {
    std::vector<std::string> out;
    for (const std::string& name : met_.missing)
      out.push_back("\"" + name + "\" is not cached: strands inside it are not judged");
    const auto inside = std::count_if(combed_.begin(), combed_.end(), [](double depth) { return depth > k_deep; });
    if (inside > 0)
      out.push_back(
          fmt::format("{} vertices of \"{}\" are inside a body in the first frame: of those only what goes "
                      "deeper is counted",
                      inside, track_.name));
    return out;
  }

 private:
  double length(std::span<const Vec3> x, std::size_t s) const {
    double sum = 0;
    for (int v = first_[s] + 1; v < first_[s + 1]; ++v) sum += (x[at(v)] - x[at(v - 1)]).norm();
    return sum;
  }
  int strand_of(int vertex) const {
    return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), vertex) - first_.begin()) - 1;
  }
  CacheTrack track_;
  MetBodies met_;
  std::vector<int> first_;
  std::vector<double> rest_;    ///< lengths of strands in the first frame [m]
  std::vector<double> combed_;  ///< depths of vertices in the first frame: roots, and what was combed inside [m]
};

}  // namespace

Result<std::unique_ptr<JudgedGroup>> judged_hair(const CachedBake& bake, const ManifestSystem& system) {
  auto track = bake.open(system);
  if (!track) return track.error();
  auto met = met_bodies(bake, system);
  if (!met) return met.error();
  return std::unique_ptr<JudgedGroup>(std::make_unique<JudgedHair>(std::move(*track), std::move(*met)));
}

}  // namespace ft::inline baker
