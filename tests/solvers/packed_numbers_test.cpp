// The numbers that energies keep in few bytes, against what went in: vertices of groups of elements, places of blocks.
#include <gtest/gtest.h>

#include <algorithm>

#include "baker/core/random.h"
#include "solvers/energies/block_positions.h"
#include "solvers/energies/group_indices.h"

namespace ft {
namespace {

using Group = GroupIndices<3>::Group;

Group numbers_from(int lowest, int span, std::uint64_t seed) {
  Group out;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t l = 0; l < k_lanes; ++l)
      out.column[c][l] = lowest + static_cast<int>(span * random_uniform({seed, 0, 0, c}, l));
  out.column[0][0] = lowest;
  out.column[2][k_lanes - 1] = lowest + span;
  return out;
}

TEST(GroupIndices, Give_back_what_went_in_near_or_far) {
  GroupIndices<3> indices;
  std::vector<Group> groups;
  int far = 0;
  for (const int lowest : {0, 5, 1 << 20, 2147483647 - 70000})
    for (const int span : {0, 1, 65534, 65535, 65536, 70000}) {
      groups.push_back(numbers_from(lowest, span, groups.size()));
      indices.push_back(groups.back());
      far += span > 65535;
      EXPECT_EQ(indices.far_count(), at(far)) << lowest << " " << span;
    }
  ASSERT_EQ(indices.size(), groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    Group out;
    indices.get(g, out);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t l = 0; l < k_lanes; ++l) {
        EXPECT_EQ(out.column[c][l], groups[g].column[c][l]);
        EXPECT_EQ(indices.number(g * k_lanes + l, c), groups[g].column[c][l]);
      }
  }
}

TEST(GroupIndices, Of_a_schedule_repeat_the_first_element_of_a_group_in_its_padding) {
  ElementSchedule schedule;
  schedule.count = k_lanes + 3;
  const auto indices = group_indices<2>(schedule, [](std::size_t slot) {
    return std::array<int, 2>{static_cast<int>(slot), static_cast<int>(100 + slot)};
  });
  ASSERT_EQ(indices.size(), 2u);
  for (std::size_t slot = 0; slot < 2 * k_lanes; ++slot) {
    const int expected = static_cast<int>(slot < schedule.count ? slot : k_lanes);
    EXPECT_EQ(indices.number(slot, 0), expected);
    EXPECT_EQ(indices.number(slot, 1), 100 + expected);
  }
}

/// Triangles of a fan around vertex 0: its row has a block for each of them, more than a byte counts in large ones.
class Fan : public testing::TestWithParam<int> {};

TEST_P(Fan, Every_block_is_found_where_the_pattern_has_it) {
  const int count = GetParam();
  std::vector<std::array<int, 4>> triangles;
  for (int i = 0; i < count; ++i) {
    std::array<int, 4> t{i + 1, 0, 1 + (i + 1) % count, -1};
    std::rotate(t.begin(), t.begin() + i % 3, t.begin() + 3);
    triangles.push_back(t);
  }
  const BlockPattern pattern = make_pattern(count + 1, std::array{triangles});
  BlockPositions<3> positions;
  positions.bind(pattern, triangles.size(),
                 [&](std::size_t slot, std::size_t corner) { return triangles[slot][corner]; });
  for (std::size_t slot = 0; slot < triangles.size(); ++slot)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) {
        const int va = triangles[slot][a], vb = triangles[slot][b];
        EXPECT_EQ(positions.place(slot, a, b, va, vb), pattern.find(std::min(va, vb), std::max(va, vb)));
      }
  for (std::size_t group = 0; (group + 1) * k_lanes <= triangles.size(); ++group) {
    LaneInts vertex[3], diagonal[3];
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t l = 0; l < k_lanes; ++l) vertex[c][l] = triangles[group * k_lanes + l][c];
      diagonal[c] = diagonal_places(pattern.diagonal, vertex[c]);
    }
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = a + 1; b < 3; ++b) {
        const LaneInts place = positions.places(group, a, b, vertex, diagonal);
        for (std::size_t l = 0; l < k_lanes; ++l)
          EXPECT_EQ(place[l], positions.place(group * k_lanes + l, a, b, vertex[a][l], vertex[b][l]));
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Fan, testing::Values(6, 40, 254, 255, 256, 1000));

}  // namespace
}  // namespace ft
