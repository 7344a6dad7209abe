#include "baker/core/give_back.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace ft {
namespace {

TEST(GiveBack, Leaves_containers_empty_and_without_room) {
  std::vector<double> numbers(100, 1.0);
  std::vector<std::vector<int>> lists(3, std::vector<int>(5));
  std::map<int, int> pairs{{1, 2}};
  give_back(numbers, lists, pairs);
  EXPECT_EQ(numbers.capacity(), 0u);
  EXPECT_EQ(lists.capacity(), 0u);
  EXPECT_TRUE(pairs.empty());
}

}  // namespace
}  // namespace ft
