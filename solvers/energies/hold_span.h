// When a pin or an attachment holds: from a time on, until a time, and how gently it comes and goes. A function of the
// time alone, so that a resume, a rewind or other substeps find it as it was.
#pragma once

#include <algorithm>
#include <limits>

namespace ft::inline solvers {

struct HoldSpan {
  double from = -std::numeric_limits<double>::infinity();  ///< s of the shot's time; nothing is held up to this instant
  double until = std::numeric_limits<double>::infinity();  ///< s; the last instant at which all is held
  double fade = 0;  ///< s that the force takes to grow after `from` and to vanish after `until`, linearly; 0: at once

  /// Share of the force at a time, 0..1.
  double share(double time) const {
    if (fade > 0)
      return std::min(std::clamp((time - from) / fade, 0.0, 1.0), 1 - std::clamp((time - until) / fade, 0.0, 1.0));
    return time > from + k_instant && time <= until + k_instant ? 1 : 0;
  }
  /// True when the force jumps between two times: an integrator with a history has to start anew there.
  bool jumps(double time_t0, double time_t1) const { return fade <= 0 && share(time_t0) != share(time_t1); }

  /// Times of one instant that were computed in different ways differ by less than this [s].
  static constexpr double k_instant = 1e-9;
};

}  // namespace ft::inline solvers
