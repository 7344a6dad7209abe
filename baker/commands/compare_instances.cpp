#include "baker/commands/compare_instances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/commands/compare.h"
#include "baker/commands/compare_pairs.h"
#include "baker/commands/compare_report.h"

namespace ft::inline baker {
namespace {

std::string prototype_of(const InstanceSet& set, std::size_t i) {
  const int p = set.prototypes[i];
  return at(p) < set.prototype_names.size() ? set.prototype_names[at(p)] : std::to_string(p);
}

std::vector<ComparedPair> pair_up(const InstanceSet& a, const InstanceSet& b, InstanceDifference& out) {
  ComparedPairs pairs = pair_by_id(a.ids, b.ids);
  out.missing = std::move(pairs.missing), out.extra = std::move(pairs.extra);
  for (const ComparedPair& pair : pairs.both)
    if (prototype_of(a, pair.in_a) != prototype_of(b, pair.in_b)) out.replaced.push_back(a.ids[pair.in_a]);
  out.common = static_cast<int>(pairs.both.size());
  return std::move(pairs.both);
}

/// Between two orientations, of which q and -q are one [degrees].
double angle(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b) {
  if (a.coeffs() == b.coeffs() || a.coeffs() == -b.coeffs()) return 0;
  const Quat turn = a.cast<double>().conjugate() * b.cast<double>();
  return 2 * std::atan2(turn.vec().norm(), std::abs(turn.w())) * 180 / std::numbers::pi;
}

}  // namespace

Status compare_instances(CacheReader& a, CacheReader& b, CompareReport& r) {
  const CacheInfo &info_a = a.info(), &info_b = b.info();
  InstanceDifference& out = r.instances.emplace();
  out.ids = info_a.instances.ids;
  const std::vector<ComparedPair> pairs = pair_up(info_a.instances, info_b.instances, out);
  const bool scales = info_a.content.scales && info_b.content.scales;
  const bool spins = info_a.content.angular_velocities && info_b.content.angular_velocities;
  std::vector<double> distances, turns;
  double square_sum = 0, turn_square_sum = 0;
  FrameData x, y;
  for (int i = 0; i < info_a.frame_count; ++i) {
    if (const Status s = a.read(i, x); !s) return s;
    if (const Status s = b.read(i, y); !s) return s;
    FrameDifference f;
    f.frame = r.first_frame + i;
    double frame_sum = 0;
    std::vector<Vec3f> places;
    std::vector<float> offs;
    for (const auto& [in_a, in_b] : pairs) {
      const double d = distance(x.positions[in_a], y.positions[in_b]),
                   t = angle(x.orientations[in_a], y.orientations[in_b]);
      raise(d, in_a, f.max, f.vertex);
      raise(t, in_a, f.turn, f.turn_vertex);
      if (r.velocities) raise(distance(x.velocities[in_a], y.velocities[in_b]), in_a, f.max_speed, f.speed_vertex);
      if (scales) f.scale = std::max(f.scale, distance(x.scales[in_a], y.scales[in_b]));
      if (spins)
        f.spin =
            std::max(f.spin, distance(x.angular_velocities[in_a], y.angular_velocities[in_b]) * 180 / std::numbers::pi);
      frame_sum += d * d;
      turn_square_sum += t * t;
      distances.push_back(d);
      turns.push_back(t);
      places.push_back(y.positions[in_b]);
      offs.push_back(static_cast<float>(d));
    }
    f.rms = pairs.empty() ? 0 : std::sqrt(frame_sum / static_cast<double>(pairs.size()));
    square_sum += frame_sum;
    out.turn_max = std::max(out.turn_max, f.turn);
    out.scale_max = std::max(out.scale_max, f.scale);
    r.add(f, std::move(places), std::move(offs), i + 1 == info_a.frame_count);
  }
  const double count = static_cast<double>(distances.size());
  r.rms = count > 0 ? std::sqrt(square_sum / count) : 0;
  out.turn_rms = count > 0 ? std::sqrt(turn_square_sum / count) : 0;
  out.p95 = percentile(std::move(distances), 95);
  out.turn_p95 = percentile(std::move(turns), 95);
  r.verdict = r.first_diverging < 0 && out.same_set() ? CompareVerdict::k_equal : CompareVerdict::k_different;
  return {};
}

std::string instances_text(const CompareReport& r) {
  const InstanceDifference& d = *r.instances;
  std::string out = fmt::format("  instances: {} in both", d.common);
  for (const auto& [what, ids] : {std::pair("only in a", &d.missing), std::pair("only in b", &d.extra),
                                  std::pair("with another prototype", &d.replaced)})
    if (!ids->empty()) out += fmt::format(", {} {} ({})", ids->size(), what, id_list(*ids));
  const double most = r.worst < 0 ? 0 : r.frames[at(r.worst)].max;
  out +=
      fmt::format("\n  positions: rms {}, p95 {}, max {}\n", length_text(r.rms), length_text(d.p95), length_text(most));
  out += fmt::format("  rotations: rms {:.4g}, p95 {:.4g}, max {:.4g} degrees\n", d.turn_rms, d.turn_p95, d.turn_max);
  if (d.scale_max > 0) out += fmt::format("  scales: max {:.4g}\n", d.scale_max);
  return out;
}

}  // namespace ft::inline baker
