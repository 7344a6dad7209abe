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

}  // namespace
}  // namespace ft
