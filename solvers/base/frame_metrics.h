// The numbers of a frame's report, once: how each is called, in which unit, and how those of two systems become one.
// Manifests, checkpoints, sums, gates and plots walk over this list. A kind of secondary that measures something of its
// own declares it (SystemKind::metrics) and puts it into FrameReport::own.
#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "solvers/base/solver.h"

namespace ft::inline solvers {

struct Metric {
  enum class Merge { k_sum, k_max, k_min, k_and };
  std::string_view key;
  std::string_view unit;  ///< "1" for numbers without one, "" for counts
  Merge merge = Merge::k_sum;
  /// The member that holds it; none: it is in FrameReport::own under its key.
  std::variant<std::monostate, int FrameReport::*, double FrameReport::*, bool FrameReport::*> member{};
};

/// Those that every report has, in the order of the manifest. The frame's number is not among them.
std::span<const Metric> frame_metrics();

/// As a number; a flag is 0 or 1. NaN: the report does not have it.
double value_of(const FrameReport& report, const Metric& metric);

/// Two systems' reports of one frame as one; declared: metrics of kinds, beside the common ones.
FrameReport merge(const FrameReport& a, const FrameReport& b, std::span<const Metric> declared);

}  // namespace ft::inline solvers
