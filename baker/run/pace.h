// How long a frame takes, for estimates of what is left.
#pragma once

#include <cstddef>
#include <deque>

namespace ft::inline baker {

/// Mean of the last frames [s].
class Pace {
 public:
  void add(double seconds) {
    recent_.push_back(seconds);
    if (recent_.size() > 20) recent_.pop_front();
  }
  double mean() const {
    double sum = 0;
    for (const double s : recent_) sum += s;
    return recent_.empty() ? 0 : sum / static_cast<double>(recent_.size());
  }

 private:
  std::deque<double> recent_;
};

}  // namespace ft::inline baker
