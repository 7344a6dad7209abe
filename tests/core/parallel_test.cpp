#include "baker/core/parallel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ft {
namespace {

double awkward_sum() {
  return parallel_sum(100'003, 97, 0.0, [](std::size_t begin, std::size_t end) {
    double s = 0;
    for (std::size_t i = begin; i < end; ++i)
      s += std::sin(static_cast<double>(i)) * std::pow(10.0, static_cast<double>(i % 17));
    return s;
  });
}

TEST(Parallel, Sum_has_the_same_bits_for_any_thread_count) {
  double reference = 0;
  for (const int threads : {1, 2, 3, 8}) {
    ThreadLimit limit(threads);
    const double s = awkward_sum();
    if (threads == 1) reference = s;
    EXPECT_EQ(s, reference) << threads;
  }
}

TEST(Parallel, Maximum_is_that_of_all_blocks_and_at_least_zero) {
  for (const std::size_t largest : {0, 9, 10, 500, 999}) {
    const auto of = [&](double sign) {
      return parallel_max(std::size_t{1000}, 10, 0.0, [&](std::size_t begin, std::size_t end) {
        return begin <= largest && largest < end ? sign * 7 : -1.0;
      });
    };
    EXPECT_EQ(of(1), 7);
    EXPECT_EQ(of(-1), 0);
  }
  EXPECT_EQ(parallel_max(std::size_t{0}, 10, 3, [](std::size_t, std::size_t) { return 5; }), 3);
}

TEST(Parallel, Loop_visits_every_index_once) {
  std::vector<int> seen(1001, 0);
  parallel_for(seen.size(), 10, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++seen[i];
  });
  for (const int n : seen) EXPECT_EQ(n, 1);
}

}  // namespace
}  // namespace ft
