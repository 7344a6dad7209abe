#include "collision/broad_phase/pair_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "baker/core/random.h"

namespace ft {
namespace {

PairKey pair(int i) {
  return pair_key(i / 3, 3 * i);
}

TEST(PairRuns, AddsWhatIsMissingBehindTheRest) {
  std::vector<PairKey> list{pair(1), pair(4), pair(9)};
  PairRuns runs;
  runs.begin();
  runs.add(std::vector{pair(0), pair(4), pair(10)}, list);
  EXPECT_EQ(list, (std::vector{pair(1), pair(4), pair(9), pair(0), pair(10)}));
  runs.add(std::vector{pair(0), pair(1), pair(9), pair(10)}, list);
  EXPECT_EQ(list.size(), 5u);
}

/// Against a set, over many rounds of adding and dropping, at sizes of several blocks.
TEST(PairRuns, IsASetThatKeepsItsOrder) {
  std::uint64_t draw = 0;
  const auto chance = [&](double share) { return random_uniform({7}, draw++) < share; };
  std::vector<PairKey> list;
  for (int i = 0; i < 9000; i += 1 + static_cast<int>(3 * random_uniform({8}, draw++))) list.push_back(pair(i));
  std::set<PairKey> wanted(list.begin(), list.end());
  PairRuns runs;
  runs.begin();
  for (int round = 0; round < 12; ++round) {
    const std::vector<PairKey> before = list;
    std::vector<PairKey> fresh;
    for (int i = 0; i < 9000; ++i)
      if (chance(0.2)) fresh.push_back(pair(i));
    wanted.insert(fresh.begin(), fresh.end());
    runs.add(fresh, list);
    ASSERT_TRUE(std::equal(before.begin(), before.end(), list.begin()));
    ASSERT_EQ(std::set<PairKey>(list.begin(), list.end()), wanted);
    ASSERT_EQ(list.size(), wanted.size());

    const int every = 3 + round;
    const auto drop = [&](PairKey key) { return key_second(key) % every == 0; };
    std::vector<PairKey> left = list;
    std::erase_if(left, drop);
    std::erase_if(wanted, drop);
    runs.erase_if(list, drop);
    ASSERT_EQ(list, left);
  }
  runs.erase_if(list, [](PairKey) { return true; });
  EXPECT_TRUE(list.empty());
  runs.add(std::vector{pair(2)}, list);
  EXPECT_EQ(list, std::vector{pair(2)});
}

}  // namespace
}  // namespace ft
