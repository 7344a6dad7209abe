#include "baker/commands/compare_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/commands/compare.h"
#include "baker/commands/compare_pairs.h"
#include "baker/commands/compare_report.h"

namespace ft::inline baker {

Status compare_points(CacheReader& a, CacheReader& b, CompareReport& r) {
  PointDifference& out = r.points.emplace();
  std::vector<double> distances;
  double square_sum = 0;
  FrameData x, y;
  for (int i = 0; i < a.info().frame_count; ++i) {
    if (const Status s = a.read(i, x); !s) return s;
    if (const Status s = b.read(i, y); !s) return s;
    FrameDifference f;
    f.frame = r.first_frame + i;
    const ComparedPairs pairs = pair_by_id(x.ids, y.ids);
    out.common += pairs.both.size(), out.missing += pairs.missing.size(), out.extra += pairs.extra.size();
    if (out.first_other_set < 0 && !(pairs.missing.empty() && pairs.extra.empty())) out.first_other_set = f.frame;
    double frame_sum = 0;
    int at_most = -1, at_speed = -1;
    std::vector<Vec3f> places;
    std::vector<float> offs;
    for (const auto& [in_a, in_b] : pairs.both) {
      const double d = distance(x.positions[in_a], y.positions[in_b]);
      raise(d, in_a, f.max, at_most);
      if (r.velocities) raise(distance(x.velocities[in_a], y.velocities[in_b]), in_a, f.max_speed, at_speed);
      if (!x.widths.empty() && !y.widths.empty())
        out.width_max = std::max(out.width_max, static_cast<double>(std::abs(x.widths[in_a] - y.widths[in_b])));
      frame_sum += d * d;
      distances.push_back(d);
      places.push_back(y.positions[in_b]);
      offs.push_back(static_cast<float>(d));
    }
    const auto listed = [&](int element) {
      if (element < 0) return -1;
      out.ids.push_back(x.ids[at(element)]);
      return static_cast<int>(out.ids.size()) - 1;
    };
    f.vertex = listed(at_most), f.speed_vertex = listed(at_speed);
    f.rms = pairs.both.empty() ? 0 : std::sqrt(frame_sum / static_cast<double>(pairs.both.size()));
    square_sum += frame_sum;
    r.add(f, std::move(places), std::move(offs), i + 1 == a.info().frame_count);
  }
  r.rms = distances.empty() ? 0 : std::sqrt(square_sum / static_cast<double>(distances.size()));
  out.p95 = percentile(std::move(distances), 95);
  const bool equal = r.first_diverging < 0 && out.same_set() && out.width_max <= r.tolerance;
  r.verdict = equal ? CompareVerdict::k_equal : CompareVerdict::k_different;
  return {};
}

std::string points_text(const CompareReport& r) {
  const PointDifference& d = *r.points;
  std::string out =
      fmt::format("  points of all frames: {} in both, {} only in a, {} only in b", d.common, d.missing, d.extra);
  if (d.first_other_set >= 0) out += fmt::format(", first in frame {}", d.first_other_set);
  const double most = r.worst < 0 ? 0 : r.frames[at(r.worst)].max;
  out +=
      fmt::format("\n  positions: rms {}, p95 {}, max {}\n", length_text(r.rms), length_text(d.p95), length_text(most));
  if (d.width_max > 0) out += fmt::format("  widths: max {}\n", length_text(d.width_max));
  return out;
}

}  // namespace ft::inline baker
