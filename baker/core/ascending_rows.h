// Rows of ascending numbers, as of a mesh's features that lie near each other: two bytes for each number, four for the
// first of a row, six after a wide gap. Written once, read from the front.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "baker/core/check.h"
#include "baker/core/types.h"

namespace ft {

class AscendingRows {
 public:
  /// numbers: each larger than the one before, none below 0.
  void push_back(std::span<const int> numbers) {
    int last = k_none;
    for (const int number : numbers) {
      CHECK(number >= 0 && number > last);
      if (last == k_none || number - last >= k_far) {
        if (last != k_none) words_.push_back(k_far);
        words_.push_back(static_cast<Word>(number & 0xFFFF));
        words_.push_back(static_cast<Word>(number >> 16));
      } else {
        words_.push_back(static_cast<Word>(number - last));
      }
      last = number;
    }
    CHECK(words_.size() <= std::numeric_limits<std::uint32_t>::max());
    start_.push_back(static_cast<std::uint32_t>(words_.size()));
  }

  /// Once all are there.
  void shrink_to_fit() {
    start_.shrink_to_fit();
    words_.shrink_to_fit();
  }

  int row_count() const { return static_cast<int>(start_.size()) - 1; }
  /// visit(number), in order.
  template <class Visit>
  void for_each(int row, Visit&& visit) const {
    const Word *next = words_.data() + start_[at(row)], *end = words_.data() + start_[at(row) + 1];
    if (next == end) return;
    const auto whole = [&] {
      const int low = *next++;
      return low | *next++ << 16;
    };
    int number = whole();
    visit(number);
    while (next < end) {
      const Word step = *next++;
      number = step == k_far ? whole() : number + step;
      visit(number);
    }
  }
  /// A copy.
  std::vector<int> row(int i) const {
    std::vector<int> out;
    for_each(i, [&](int number) { out.push_back(number); });
    return out;
  }

 private:
  using Word = std::uint16_t;
  static constexpr int k_none = -1;
  static constexpr Word k_far = 0xFFFF;  ///< a whole number follows, and no distance from the last one

  std::vector<std::uint32_t> start_{0};  ///< of the rows, and their end
  std::vector<Word> words_;              ///< of a row: its first number in two, then distances
};

}  // namespace ft
