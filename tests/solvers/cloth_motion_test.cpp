#include "solvers/cloth/model/cloth_motion.h"

#include <gtest/gtest.h>

#include "baker/core/random.h"

namespace ft {
namespace {

constexpr std::size_t k_count = 50;

/// Cloth at 1 m that goes at some 10 m/s, in steps of 1/500 s.
ClothMotion some_motion() {
  const auto somewhere = [](std::uint64_t draw, double size) {
    std::vector<Vec3> out;
    for (std::uint64_t i = 0; i < k_count; ++i)
      out.emplace_back(size * random_uniform({1, draw, 0, i}, 0), size * random_uniform({1, draw, 0, i}, 1),
                       size * random_uniform({1, draw, 0, i}, 2));
    return out;
  };
  ClothMotion m;
  m.x = somewhere(0, 1);
  m.v = somewhere(1, 10);
  m.v_previous = somewhere(2, 10);
  m.v_older = somewhere(3, 10);
  m.h_previous = 0.002;
  m.h_older = 0.0017;
  m.x_previous = m.x_older = m.x;
  for (std::size_t i = 0; i < k_count; ++i) {
    m.x_previous[i] -= m.h_previous * m.v[i];
    m.x_older[i] = m.x_previous[i] - m.h_older * m.v_previous[i];
    m.tangled.push_back(i % 5 == 0);
  }
  for (int b = 0; b < 90; ++b) m.absent.push_back(b % 30 < 7 || b == 89);  // of a collider of 45, for two garments
  return m;
}

TEST(ClothMotion, Goes_through_a_state_bit_for_bit_and_leaves_nothing_in_it) {
  const ClothMotion m = some_motion();
  State state;
  store(state, m);
  const State copy = state;
  const ClothMotion back = take_motion(state, k_count);
  EXPECT_EQ(back.x, m.x);
  EXPECT_EQ(back.v, m.v);
  EXPECT_EQ(back.x_previous, m.x_previous);
  EXPECT_EQ(back.v_previous, m.v_previous);
  EXPECT_EQ(back.x_older, m.x_older);
  EXPECT_EQ(back.v_older, m.v_older);
  EXPECT_EQ(back.h_previous, m.h_previous);
  EXPECT_EQ(back.h_older, m.h_older);
  EXPECT_EQ(back.absent, m.absent);
  EXPECT_EQ(back.tangled, m.tangled);
  for (const StateBlock& block : state.blocks) EXPECT_TRUE(block.values.read().empty()) << block.name;
  EXPECT_EQ(copy.find("x")->size(), 3 * k_count);  // others keep what they have in common with it
  State again = state;
  store(again, back);
  EXPECT_EQ(hash(again), hash(copy));
}

TEST(ClothMotion, Is_kept_with_its_places_to_the_bit_the_last_step_to_seven_digits_and_nothing_older) {
  const ClothMotion m = some_motion(), kept = KeptMotion(m).motion();
  EXPECT_EQ(kept.x, m.x);
  EXPECT_EQ(kept.absent, m.absent);
  EXPECT_EQ(kept.tangled, m.tangled);
  EXPECT_EQ(kept.h_previous, m.h_previous);
  EXPECT_EQ(kept.h_older, 0);
  EXPECT_EQ(kept.x_older.size(), k_count);
  EXPECT_EQ(kept.v_older.size(), k_count);
  for (std::size_t i = 0; i < k_count; ++i) {
    EXPECT_LT((kept.v[i] - m.v[i]).norm(), 1e-6);
    EXPECT_LT((kept.v_previous[i] - m.v_previous[i]).norm(), 1e-6);
    EXPECT_LT((kept.x_previous[i] - m.x_previous[i]).norm(), 3e-9);
  }
}

TEST(ClothMotion, Is_kept_where_nothing_is_absent_or_tangled) {
  ClothMotion m = some_motion();
  m.absent.assign(90, 0);
  m.tangled.assign(k_count, 0);
  const ClothMotion kept = KeptMotion(m).motion();
  EXPECT_EQ(kept.absent, m.absent);
  EXPECT_EQ(kept.tangled, m.tangled);
}

}  // namespace
}  // namespace ft
