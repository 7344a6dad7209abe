#include "baker/core/state.h"

#include <gtest/gtest.h>

#include "tests/support/damage.h"

namespace ft {
namespace {

State example() {
  State s;
  s.frame = -3;
  s.time = 0.125;
  s.block("x") = {1, 2, 3};
  s.block("v") = {0.5};
  return s;
}

TEST(State, Saved_state_loads_equal) {
  const State s = example();
  auto loaded = load_state(save(s));
  ASSERT_TRUE(loaded);
  EXPECT_EQ(hash(*loaded), hash(s));
  EXPECT_EQ(loaded->frame, -3);
}

TEST(State, Checkpoint_cut_at_any_byte_is_refused) {
  const Bytes data = save(example());
  test::for_each_cut(data, [](auto cut, std::size_t size) { EXPECT_FALSE(load_state(cut)) << size; });
}

TEST(State, Checkpoint_with_any_flipped_bit_is_refused) {
  const Bytes data = save(example());
  test::for_each_flipped_bit(data, [](const Bytes& bad, std::size_t bit) { EXPECT_FALSE(load_state(bad)) << bit; });
}

TEST(State, A_copy_has_the_same_numbers_in_common_until_one_is_changed) {
  State s = example(), copy = s;
  ASSERT_EQ(copy.blocks.size(), 2u);
  for (std::size_t b = 0; b < 2; ++b) EXPECT_TRUE(copy.blocks[b].values.is(s.blocks[b].values));
  const Hash128 before = hash(s);
  s.block("x")[1] = 7;
  s.set("v", {1, 2});
  for (std::size_t b = 0; b < 2; ++b) EXPECT_FALSE(copy.blocks[b].values.is(s.blocks[b].values));
  EXPECT_EQ(hash(copy), before);
  EXPECT_EQ(*s.find("x"), (std::vector<double>{1, 7, 3}));
  EXPECT_EQ(*s.find("v"), (std::vector<double>{1, 2}));
  const double* numbers = s.block("x").data();
  EXPECT_EQ(s.block("x").data(), numbers) << "nobody else has them";
}

}  // namespace
}  // namespace ft
