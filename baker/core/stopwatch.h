// Wall time between laps; for profiles, never for results.
#pragma once

#include <chrono>

namespace ft {

class Stopwatch {
 public:
  /// Since the last lap, or since it was made [s].
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double s = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return s;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace ft
