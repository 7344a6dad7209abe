#include "solvers/base/frame_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/core/check.h"

namespace ft::inline solvers {
namespace {

double merged(double a, double b, Metric::Merge merge) {
  switch (merge) {
    case Metric::Merge::k_sum: return a + b;
    case Metric::Merge::k_max: return std::max(a, b);
    case Metric::Merge::k_min: return std::min(a, b);
    case Metric::Merge::k_and: return a != 0 && b != 0 ? 1 : 0;
  }
  return a;
}

void merge_into(FrameReport& out, const FrameReport& b, const Metric& metric) {
  if (const auto* whole = std::get_if<int FrameReport::*>(&metric.member))
    out.** whole = static_cast<int>(merged(out.**whole, b.**whole, metric.merge));
  else if (const auto* number = std::get_if<double FrameReport::*>(&metric.member))
    out.** number = merged(out.**number, b.**number, metric.merge);
  else if (const auto* flag = std::get_if<bool FrameReport::*>(&metric.member))
    out.** flag = merged(out.**flag, b.**flag, metric.merge) != 0;
  else if (const auto theirs = b.own.find(metric.key); theirs != b.own.end()) {
    const auto [ours, is_new] = out.own.emplace(*theirs);
    if (!is_new) ours->second = merged(ours->second, theirs->second, metric.merge);
  }
}

}  // namespace

std::span<const Metric> frame_metrics() {
  using Merge = Metric::Merge;
  static const Metric metrics[] = {
      {"substeps", "", Merge::k_max, &FrameReport::substeps},
      {"newton_iterations", "", Merge::k_sum, &FrameReport::newton_iterations},
      {"linear_iterations", "", Merge::k_sum, &FrameReport::linear_iterations},
      {"rewinds", "", Merge::k_sum, &FrameReport::rewinds},
      {"crossings_body", "", Merge::k_sum, &FrameReport::crossings_body},
      {"crossings_self", "", Merge::k_sum, &FrameReport::crossings_self},
      {"crossings_drawn", "", Merge::k_sum, &FrameReport::crossings_drawn},
      {"smallest_gap", "m", Merge::k_min, &FrameReport::smallest_gap},
      {"deepest_drawn", "m", Merge::k_max, &FrameReport::deepest_drawn},
      {"inside_body", "", Merge::k_sum, &FrameReport::inside_body},
      {"open_stitches", "", Merge::k_sum, &FrameReport::open_stitches},
      {"widest_seam", "m", Merge::k_max, &FrameReport::widest_seam},
      {"strain_p99", "1", Merge::k_max, &FrameReport::strain_p99},
      {"strain_max", "1", Merge::k_max, &FrameReport::strain_max},
      {"strain_mean", "1", Merge::k_max, &FrameReport::strain_mean},
      {"kinetic_energy", "J", Merge::k_sum, &FrameReport::kinetic_energy},
      {"absent_vertices", "", Merge::k_max, &FrameReport::absent_vertices},
      {"crossings_absent", "", Merge::k_sum, &FrameReport::crossings_absent},
      {"released_vertices", "", Merge::k_sum, &FrameReport::released_vertices},
      {"finite", "", Merge::k_and, &FrameReport::finite},
  };
  return metrics;
}

double value_of(const FrameReport& report, const Metric& metric) {
  if (const auto* whole = std::get_if<int FrameReport::*>(&metric.member)) return report.**whole;
  if (const auto* number = std::get_if<double FrameReport::*>(&metric.member)) return report.**number;
  if (const auto* flag = std::get_if<bool FrameReport::*>(&metric.member)) return report.**flag ? 1 : 0;
  const auto own = report.own.find(metric.key);
  return own == report.own.end() ? std::numeric_limits<double>::quiet_NaN() : own->second;
}

FrameReport merge(const FrameReport& a, const FrameReport& b, std::span<const Metric> declared) {
  CHECK(a.frame == b.frame);
  FrameReport out = a;
  for (const Metric& metric : frame_metrics()) merge_into(out, b, metric);
  for (const Metric& metric : declared) merge_into(out, b, metric);
  out.forces.insert(out.forces.end(), b.forces.begin(), b.forces.end());
  out.absent.insert(out.absent.end(), b.absent.begin(), b.absent.end());
  out.incidents.insert(out.incidents.end(), b.incidents.begin(), b.incidents.end());
  out.profile += b.profile;
  return out;
}

}  // namespace ft::inline solvers
