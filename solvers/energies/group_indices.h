// Numbers that go with the elements of a group (its vertices, its neighbours) in little more than half of the memory: a
// base per group and 16 bits for each number. Elements that are visited together lie near each other, and so, in most
// meshes, do the numbers of what they touch. Groups whose numbers lie farther apart are kept as they are.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "baker/core/check.h"
#include "baker/core/types.h"
#include "solvers/energies/element_schedule.h"

namespace ft::inline solvers {

template <int Columns>
class GroupIndices {
 public:
  /// Of k_lanes elements.
  struct Group {
    alignas(32) int column[Columns][k_lanes];
  };

  void reserve(std::size_t groups) { near_.reserve(groups); }
  /// Behind those that are there; no number is below 0.
  void push_back(const Group& group) {
    const int *first = &group.column[0][0], *end = first + Columns * k_lanes;
    const auto [lowest, highest] = std::minmax_element(first, end);
    CHECK(*lowest >= 0);
    Near packed{};
    packed.base = *lowest;
    if (*highest - *lowest > k_farthest) {
      packed.base = -1 - static_cast<int>(far_.size());
      far_.push_back(group);
    } else {
      for (std::size_t c = 0; c < Columns; ++c)
        for (std::size_t l = 0; l < k_lanes; ++l)
          packed.offset[c][l] = static_cast<std::uint16_t>(group.column[c][l] - *lowest);
    }
    near_.push_back(packed);
  }
  std::size_t size() const { return near_.size(); }
  /// Groups that are kept as they are.
  std::size_t far_count() const { return far_.size(); }

  void get(std::size_t group, Group& out) const {
    const Near& packed = near_[group];
    if (packed.base < 0) {
      out = far_[at(-1 - packed.base)];
      return;
    }
    for (std::size_t c = 0; c < Columns; ++c)
      for (std::size_t l = 0; l < k_lanes; ++l) out.column[c][l] = packed.base + packed.offset[c][l];
  }

  /// Of one element.
  int number(std::size_t slot, std::size_t column) const {
    const Near& packed = near_[slot / k_lanes];
    return packed.base < 0 ? far_[at(-1 - packed.base)].column[column][slot % k_lanes]
                           : packed.base + packed.offset[column][slot % k_lanes];
  }

 private:
  static constexpr int k_farthest = 0xFFFF;
  struct Near {
    int base;  ///< below 0: group -1 - base of far_
    std::uint16_t offset[Columns][k_lanes];
  };
  std::vector<Near> near_;
  std::vector<Group> far_;
};

/// numbers(slot): an array of the Columns numbers of an element. Padding has those of the first element of its group.
template <int Columns, class Numbers>
GroupIndices<Columns> group_indices(const ElementSchedule& schedule, Numbers&& numbers) {
  GroupIndices<Columns> out;
  out.reserve(schedule.group_count());
  for (std::size_t group = 0; group < schedule.group_count(); ++group) {
    typename GroupIndices<Columns>::Group whole;
    for (std::size_t l = 0; l < k_lanes; ++l) {
      const auto of_element = numbers(group * k_lanes + (l < schedule.used(group) ? l : 0));
      for (std::size_t c = 0; c < Columns; ++c) whole.column[c][l] = of_element[c];
    }
    out.push_back(whole);
  }
  return out;
}

}  // namespace ft::inline solvers
