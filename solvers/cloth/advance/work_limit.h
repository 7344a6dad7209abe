// What a walk through a frame may cost in the cloth solver, whatever the body does. Counted and not timed, so that
// every machine stops at the same place. A search for pairs is 1, an iteration of Newton's method 1/3, so that an
// undisturbed substep is about 2; both are more where there are very many pairs. Beyond the limit what blocks is let go
// (body_advance.cpp). Caution: that is a last resort. Cloth that is let through in haste is let through anything.
#pragma once

#include <algorithm>
#include <cstddef>

namespace ft::inline solvers {

class WorkLimit {
 public:
  /// torn: the body is, in this frame; no pains are taken then, for nothing is right.
  WorkLimit(int substeps, bool torn) : left_((torn ? 1 : k_most_times) * k_undisturbed * substeps) {}

  void spend(double work) { left_ -= work; }
  /// Of the substep that comes next, when so many others follow it.
  double patience(int substeps_after) const { return left_ - k_undisturbed * substeps_after; }

  static double of_search(std::size_t pairs, std::size_t vertices) { return crowd(pairs, vertices); }
  static double of_iteration(std::size_t pairs, std::size_t vertices) { return crowd(pairs, vertices) / 3; }

 private:
  static constexpr double k_undisturbed = 2;  ///< work of a substep
  /// So many times that of max_substeps undisturbed ones [1]. The most in 210 shots of all kinds of motion were 108
  /// pieces with 396 iterations in a frame, which is two thirds of it. times.
  static constexpr double k_most_times = 6;
  /// Pairs for each vertex of the cloth of which nothing is seen in the time [1].
  static constexpr double k_many_pairs = 32;

  static double crowd(std::size_t pairs, std::size_t vertices) {
    return std::max(
        1.0, static_cast<double>(pairs) / (k_many_pairs * static_cast<double>(std::max(vertices, std::size_t{1}))));
  }

  double left_;
};

}  // namespace ft::inline solvers
