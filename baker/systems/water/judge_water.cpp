#include "baker/systems/water/judge_water.h"

#include <fmt/format.h>

#include <limits>

namespace ft::inline baker {
namespace {

/// By which a vertex of the surface may be beside its place on the grid: rounding of the caches [m].
constexpr double k_beside = 1e-4;

class JudgedWater final : public JudgedGroup {
 public:
  explicit JudgedWater(CacheTrack track) : track_(std::move(track)) {}

  /// Reading refuses what is not finite.
  Result<FrameReport> judge(int index, int frame, std::span<const AbsentRuns>) const override {
    FrameReport report;
    report.frame = frame;
    report.smallest_gap = std::numeric_limits<double>::infinity();
    FrameData now;
    if (const Status read = track_.read(index, now); !read) return read.error();
    if (track_.shape() == OutputShape::k_points) {
      for (const float width : now.widths) report.finite = report.finite && width > 0;
      return report;
    }
    int beside = -1;
    for (std::size_t v = 0; v < now.positions.size() && beside < 0; ++v) {
      const Vec3 off = now.positions[v].cast<double>() - track_.rest.positions[v];
      if (std::hypot(off.x(), off.z()) > k_beside) beside = static_cast<int>(v);
    }
    if (beside >= 0)
      report.incidents.push_back({Incident::Kind::k_unsettled, frame, track_.name, beside,
                                  now.positions[at(beside)].cast<double>(), 0,
                                  "a vertex of the surface is not over its place on the grid"});
    report.finite = beside < 0;
    for (std::size_t n = 0; n < now.scalars.size(); ++n) {
      const auto off = std::ranges::find_if(now.scalars[n], [](float x) { return !(x >= 0 && x <= 1); });
      if (off == now.scalars[n].end()) continue;
      const int v = static_cast<int>(off - now.scalars[n].begin());
      report.incidents.push_back({Incident::Kind::k_unsettled, frame, track_.name, v,
                                  now.positions[at(v)].cast<double>(), 0,
                                  fmt::format("{} of the surface is {} at a vertex, and not within 0 and 1",
                                              track_.reader->info().content.scalars[n], *off)});
      report.finite = false;
    }
    return report;
  }

 private:
  CacheTrack track_;
};

}  // namespace

Result<std::unique_ptr<JudgedGroup>> judged_water(const CachedBake& bake, const ManifestSystem& system) {
  auto track = bake.open(system);
  if (!track) return track.error();
  return std::unique_ptr<JudgedGroup>(std::make_unique<JudgedWater>(std::move(*track)));
}

}  // namespace ft::inline baker
