// Sets that are joined two at a time, and the rows that they make.
#include "baker/core/disjoint_sets.h"

#include <gtest/gtest.h>

namespace ft {
namespace {

TEST(DisjointSets, Are_named_by_their_smallest_number_in_whatever_order_they_are_joined) {
  DisjointSets sets(6);
  EXPECT_EQ(sets.join(5, 3), 3);
  EXPECT_EQ(sets.join(4, 5), 3);
  EXPECT_EQ(sets.join(1, 4), 1);
  for (const int i : {1, 3, 4, 5}) EXPECT_EQ(sets.root(i), 1) << i;
  EXPECT_EQ(sets.root(0), 0);
  EXPECT_EQ(sets.root(2), 2);
}

TEST(DisjointSets, Of_more_than_one_number_make_ascending_rows) {
  DisjointSets sets(8);
  EXPECT_EQ(sets.groups().row_count(), 0);
  EXPECT_EQ(DisjointSets().groups().row_count(), 0);
  sets.join(7, 2), sets.join(4, 7), sets.join(6, 1);
  const Adjacency groups = sets.groups();
  EXPECT_EQ(groups.start, (std::vector<int>{0, 2, 5}));
  EXPECT_EQ(groups.items, (std::vector<int>{1, 6, 2, 4, 7}));
}

}  // namespace
}  // namespace ft
