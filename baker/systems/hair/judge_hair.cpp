#include "baker/systems/hair/judge_hair.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "baker/record/met_bodies.h"
#include "baker/systems/hair/overlapped_skin.h"
#include "collision/check/crossings.h"
#include "collision/check/penetration.h"
#include "collision/geometry/triangle_tree.h"
#include "io/hair/resample.h"
#include "solvers/hair/hair_setup.h"

namespace ft::inline baker {
namespace {

/// Of a segment's ends, inside of a body: less is what caches round, and what skin is refined by [m].
constexpr double k_deep = 1e-4;

/// Of segments, called after their second vertex: those that go through a sheet.
std::vector<int> segments_through(std::span<const Vec3> x, std::span<const int> first, const CacheTrack& sheet,
                                  std::span<const Vec3> y) {
  std::vector<int> out;
  const TriangleTree tree(y, sheet.triangles);
  for (std::size_t s = 0; s + 1 < first.size(); ++s)
    for (int v = first[s] + 1; v < first[s + 1]; ++v)
      if (edge_crosses_any(x[at(v - 1)], x[at(v)], tree, y, sheet.triangles)) out.push_back(v);
  return out;
}

class JudgedHair final : public JudgedGroup {
 public:
  /// Error: the first frame cannot be read.
  static Result<std::unique_ptr<JudgedGroup>> make(CacheTrack track, MetBodies met) {
    auto out = std::make_unique<JudgedHair>(std::move(track), std::move(met));
    if (const Status read = out->read_first_frame(); !read) return read.error();
    return std::unique_ptr<JudgedGroup>(std::move(out));
  }
  JudgedHair(CacheTrack track, MetBodies met) : track_(std::move(track)), met_(std::move(met)) {
    for (const CacheTrack& body : met_.bodies) skins_.emplace_back(body.rest.positions, body.triangles);
  }

  Result<FrameReport> judge(int index, int frame, std::span<const AbsentRuns>) const override {
    std::vector<Vec3> x;
    if (const Status read = track_.read(index, x); !read) return read.error();
    FrameReport report;
    report.frame = frame;
    report.smallest_gap = std::numeric_limits<double>::infinity();
    std::vector<double> off;
    for (std::size_t s = 0; s < lengths_.size(); ++s) off.push_back(std::abs(length(x, s) / lengths_[s] - 1));
    std::sort(off.begin(), off.end());
    if (!off.empty()) {
      report.strain_max = off.back();
      report.strain_p99 = off[(off.size() - 1) * 99 / 100];
    }
    for (const CacheTrack& body : met_.bodies) {
      std::vector<Vec3> y;
      if (const Status read = body.read(index, y); !read) return read.error();
      if (body.sheet)
        judge_sheet(x, body, y, report);
      else
        judge_body(x, body, skins_[at(&body - met_.bodies.data())], y, report);
    }
    return report;
  }
  std::vector<std::string> notes() const override {
    std::vector<std::string> out;
    for (const std::string& name : met_.missing)
      out.push_back("\"" + name + "\" is not cached: strands in it are not judged");
    const auto inside = std::count_if(combed_.begin(), combed_.end(), [](double depth) { return depth > k_deep; });
    if (inside > 0)
      out.push_back(fmt::format("{} vertices of \"{}\" are inside a body in the first frame and not judged", inside,
                                track_.name));
    const auto through = std::count(through_.begin(), through_.end(), 1);
    if (through > 0)
      out.push_back(fmt::format("{} segments of \"{}\" are through a sheet in the first frame and not judged", through,
                                track_.name));
    return out;
  }

 private:
  Status read_first_frame() {
    const CurveSet& curves = track_.reader->info().curves;
    first_.push_back(0);
    for (const int count : curves.vertices_per_curve) first_.push_back(first_.back() + count);
    std::vector<Vec3> start;
    if (const Status read = track_.read(0, start); !read) return read;
    combed_.assign(start.size(), 0.0);
    held_.assign(first_.size() - 1, 1);
    for (const CacheAttribute& attribute : track_.reader->info().attributes)
      if (const auto* held = std::get_if<std::vector<std::int16_t>>(&attribute.values);
          held && attribute.name == k_held && held->size() == held_.size())
        held_ = *held;
    through_.assign(start.size(), 0);
    for (std::size_t s = 0; s + 1 < first_.size(); ++s) lengths_.push_back(length(start, s));
    for (const CacheTrack& body : met_.bodies) {
      std::vector<Vec3> y;
      if (const Status read = body.read(0, y); !read) return read;
      if (body.sheet) {
        for (const int v : segments_through(start, first_, body, y)) through_[at(v)] = 1;
        continue;
      }
      for (const Penetration& p : penetrations(start, y, body.triangles, 0))
        combed_[at(p.vertex)] = std::max(combed_[at(p.vertex)], p.depth);
    }
    return {};
  }
  void judge_body(std::span<const Vec3> x, const CacheTrack& body, const OverlappedSkin& skin, std::span<const Vec3> y,
                  FrameReport& report) const {
    TriangleTree tree;
    for (const Penetration& p : penetrations(x, y, body.triangles, k_deep)) {
      if (combed_[at(p.vertex)] > k_deep || is_held(p.vertex)) continue;
      if (tree.empty()) tree = TriangleTree(y, body.triangles);
      if (skin.holds(x[at(p.vertex)], tree, y)) {
        ++report.crossings_absent;
        continue;
      }
      ++report.inside_body;
      ++report.crossings_body;
      if (p.depth <= report.deepest_drawn) continue;
      report.deepest_drawn = p.depth;
      report.incidents.assign(1, {Incident::Kind::k_penetration, report.frame, track_.name, strand_of(p.vertex),
                                  x[at(p.vertex)], p.depth, fmt::format("a strand is inside \"{}\"", body.name)});
    }
  }
  void judge_sheet(std::span<const Vec3> x, const CacheTrack& sheet, std::span<const Vec3> y,
                   FrameReport& report) const {
    std::vector<int> found = segments_through(x, first_, sheet, y);
    std::erase_if(found, [&](int v) { return through_[at(v)] != 0; });
    // What is tied goes with its root, wherever the sheet is.
    report.crossings_absent += static_cast<int>(std::erase_if(found, [&](int v) { return is_held(v); }));
    if (found.empty()) return;
    report.crossings_body += static_cast<int>(found.size());
    report.incidents.push_back({Incident::Kind::k_crossing, report.frame, track_.name, strand_of(found[0]),
                                x[at(found[0])], 0,
                                fmt::format("{} segments of strands go through \"{}\"", found.size(), sheet.name)});
  }
  double length(std::span<const Vec3> x, std::size_t s) const {
    return length_of(x.subspan(at(first_[s]), at(first_[s + 1] - first_[s])));
  }
  /// What does not move beside its root is where the groom has it.
  bool is_held(int vertex) const {
    const auto strand = at(strand_of(vertex));
    return vertex - first_[strand] < held_[strand];
  }
  int strand_of(int vertex) const {
    return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), vertex) - first_.begin()) - 1;
  }

  CacheTrack track_;
  MetBodies met_;
  std::vector<OverlappedSkin> skins_;  ///< of each of them
  std::vector<int> first_;             ///< vertex of each strand, and how many there are in all
  std::vector<double> lengths_;        ///< of strands in the first frame [m]
  std::vector<double> combed_;         ///< depths of vertices in the first frame: roots, and what was combed inside [m]
  std::vector<std::int16_t> held_;     ///< vertices of each strand, from the root on, that do not move beside it
  std::vector<char> through_;          ///< 1: in the first frame the segment that ends at the vertex is through a sheet
};

}  // namespace

Result<std::unique_ptr<JudgedGroup>> judged_hair(const CachedBake& bake, const ManifestSystem& system) {
  auto track = bake.open(system);
  if (!track) return track.error();
  auto met = met_bodies(bake, system);
  if (!met) return met.error();
  return JudgedHair::make(std::move(*track), std::move(*met));
}

}  // namespace ft::inline baker
