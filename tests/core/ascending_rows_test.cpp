#include "baker/core/ascending_rows.h"

#include <gtest/gtest.h>

#include <limits>

#include "baker/core/random.h"

namespace ft {
namespace {

TEST(AscendingRows, Give_back_what_was_put_in) {
  constexpr int most = std::numeric_limits<int>::max();
  const std::vector<std::vector<int>> rows = {
      {},
      {0},
      {most},
      {0, 1, 2, 3},
      {0xFFFE, 0xFFFF, 0x10000},
      {5, 5 + 0xFFFE, 5 + 0xFFFE + 0xFFFF, 5 + 0xFFFE + 0xFFFF + 0x10000},
      {},
      {0, most - 1, most},
  };
  AscendingRows packed;
  for (const auto& row : rows) packed.push_back(row);
  packed.shrink_to_fit();
  ASSERT_EQ(packed.row_count(), 8);
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(packed.row(static_cast<int>(i)), rows[i]) << i;
}

TEST(AscendingRows, Without_rows_are_none) {
  EXPECT_EQ(AscendingRows().row_count(), 0);
}

TEST(AscendingRows, Give_back_rows_of_any_gaps) {
  std::uint64_t draw = 0;
  const auto below = [&](int end) { return static_cast<int>(random_uniform({.element = 7}, draw++) * end); };
  AscendingRows packed;
  std::vector<std::vector<int>> rows;
  for (int i = 0; i < 2000; ++i) {
    std::vector<int> row;
    for (int number = below(1 << 20), k = below(12); k > 0; --k) {
      row.push_back(number);
      number += 1 + below(1 << (1 + below(20)));
    }
    packed.push_back(row);
    rows.push_back(std::move(row));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_EQ(packed.row(static_cast<int>(i)), rows[i]) << i;
}

}  // namespace
}  // namespace ft
