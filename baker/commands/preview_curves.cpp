#include "baker/commands/preview_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/commands/base64.h"

namespace ft::inline baker {
namespace {

constexpr std::uint64_t k_bytes_of_vertex = 8;  ///< three numbers of 16 bits in base 64
constexpr double k_steps = 65535;

/// What of the cache goes into the page.
struct Chosen {
  std::vector<std::uint32_t> counts, ids;
  std::vector<std::size_t> vertices;  ///< indices into a frame of the cache
  std::vector<float> widths;
};

/// Of a vertex of a curve, whatever the widths are of.
float width_of(const CurveSet& set, std::size_t curve, std::size_t vertex) {
  if (set.widths.size() == 1) return set.widths[0];
  return set.widths[set.widths.size() == set.vertices_per_curve.size() ? curve : vertex];
}

Chosen choose(const CurveSet& set, double share) {
  std::vector<std::size_t> starts{0};
  for (const int n : set.vertices_per_curve) starts.push_back(starts.back() + at(n));
  Chosen out;
  for (const int strand : chosen_strands(set.curve_count(), share)) {
    const std::size_t c = at(strand);
    out.counts.push_back(static_cast<std::uint32_t>(set.vertices_per_curve[c]));
    out.ids.push_back(static_cast<std::uint32_t>(set.ids.empty() ? c : set.ids[c]));
    for (std::size_t v = starts[c]; v < starts[c + 1]; ++v) {
      out.vertices.push_back(v);
      if (!set.widths.empty()) out.widths.push_back(width_of(set, c, v));
    }
  }
  return out;
}

}  // namespace

std::uint64_t preview_bytes_of_curves(const CacheTrack& track, int frames) {
  return k_bytes_of_vertex * static_cast<std::uint64_t>(frames) *
         static_cast<std::uint64_t>(track.reader->info().vertex_count);
}

std::vector<int> chosen_strands(int count, double share) {
  const int drawn = std::clamp(static_cast<int>(share * count), std::min(count, 1), count);
  std::vector<int> out;
  for (std::int64_t k = 0; k < drawn; ++k) out.push_back(static_cast<int>((2 * k + 1) * count / (2 * drawn)));
  return out;
}

Result<Json> preview_curves(const ManifestSystem& system, const CacheTrack& track, int frames, double share) {
  const CurveSet& set = track.reader->info().curves;
  const Chosen chosen = choose(set, share);
  std::vector<std::uint16_t> positions;
  positions.reserve(3 * at(frames) * chosen.vertices.size());
  std::vector<double> bounds;
  Box all;
  FrameData frame;
  for (int f = 0; f < frames; ++f) {
    if (const Status read = track.read(f, frame); !read) return read.error();
    Box box;
    for (const std::size_t v : chosen.vertices) box.include(frame.positions[v].cast<double>());
    if (box.empty()) box.include(Vec3::Zero());
    all.include(box);
    const Vec3 step = box.size() / k_steps;
    for (const Vec3& corner : {box.lo, step}) bounds.insert(bounds.end(), {corner.x(), corner.y(), corner.z()});
    for (const std::size_t v : chosen.vertices)
      for (int k = 0; k < 3; ++k) {
        const double steps = step[k] > 0 ? (static_cast<double>(frame.positions[v][k]) - box.lo[k]) / step[k] : 0;
        positions.push_back(static_cast<std::uint16_t>(std::clamp(std::round(steps), 0.0, k_steps)));
      }
  }
  const Vec3 step = all.size() / k_steps;
  Json out{{"name", system.name}, {"role", system.role}, {"vertices", chosen.vertices.size()}};
  out["low"] = {all.lo[0], all.lo[1], all.lo[2]};
  out["step"] = {step[0], step[1], step[2]};
  out["positions"] = base64_of(positions);
  Json& own = out["curves"];
  own = {{"strands", set.curve_count()},
         {"counts", base64_of(chosen.counts)},
         {"ids", base64_of(chosen.ids)},
         {"bounds", base64_of(bounds)}};
  if (!chosen.widths.empty()) own["widths"] = base64_of(chosen.widths);
  if (chosen.counts.size() < set.vertices_per_curve.size())
    own["note"] = fmt::format(
        "\"{}\": {} of {} strands are drawn, evenly chosen and wider; all of them would take {:.0f} MB of the page",
        system.name, chosen.counts.size(), set.curve_count(),
        1e-6 * static_cast<double>(preview_bytes_of_curves(track, frames)));
  return out;
}

}  // namespace ft::inline baker
