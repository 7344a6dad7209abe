// Boxes of short numbers hold what they must, no matter how the numbers round, and little more.
#include "collision/broad_phase/vertex_box.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/collision/pair_scene.h"

namespace ft {
namespace {

using test::Dice;

constexpr long double k_signs[7][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

TEST(VertexBox, Holds_the_swept_ball_however_the_numbers_round) {
  Dice dice(3);
  for (int trial = 0; trial < 100000; ++trial) {
    const double size = std::pow(10, dice.uniform(-9, 3)), r = trial % 3 == 0 ? 0.0 : size * dice.uniform(0, 0.3);
    const Vec3 middle = dice.cube(trial % 2 == 0 ? size : 1000 * size);
    const BoxFrame frame(middle - Vec3(1, 0.4, 0.7) * size, middle + Vec3(1, 0.4, 0.7) * size);
    const Vec3 a = middle + dice.cube(0.5 * size), b = trial % 5 == 0 ? a : Vec3(middle + dice.cube(0.5 * size));
    const VertexBox box = frame.swept(a, b, r);
    for (std::size_t k = 0; k < k_box_axes; ++k) {
      const auto along = [&](const Vec3& p) {
        return k_signs[k][0] * p[0] + k_signs[k][1] * p[1] + k_signs[k][2] * p[2];
      };
      const long double reach = k < 3 ? r : std::sqrt(3.0L) * r;
      const long double lo = std::min(along(a), along(b)) - reach, hi = std::max(along(a), along(b)) + reach;
      // Back in metres the origin rounds once more.
      const long double rounding = 1e-15L * (a.lpNorm<1>() + middle.lpNorm<1>());
      ASSERT_LE(frame.lo(box, k), lo + rounding);
      ASSERT_GE(frame.hi(box, k), hi - rounding);
      ASSERT_GE(frame.lo(box, k), lo - 1.01L * frame.step(k) - rounding);  // not much larger than needed
      ASSERT_LE(frame.hi(box, k), hi + 1.01L * frame.step(k) + rounding);
    }
    ASSERT_LT(frame.step(0), 4e-5 * size);
  }
}

TEST(VertexBox, What_is_outside_of_the_frame_meets_all_that_is_there_with_a_margin_too) {
  const BoxFrame frame(Vec3::Zero(), Vec3::Ones());
  const auto box_at = [&](double x, double r) {
    return BoxLanes::load(frame.swept(Vec3(x, 0.5, 0.5), Vec3(x, 0.5, 0.5), r));
  };
  const BoxMargin margin = frame.margin(0.005);
  for (const double far : {3.0, 100.0, 1e6}) {
    for (const double side : {1.0, -1.0}) {
      const BoxLanes there = box_at(side * far, 0.01), also = box_at(side * (far + 50), 0.01),
                     inside = box_at(0.5, 0.01);
      EXPECT_TRUE(there.overlaps(also) && also.overlaps(there));
      EXPECT_TRUE(there.shrunk(margin).overlaps(also) && also.shrunk(margin).overlaps(there));
      EXPECT_FALSE(there.overlaps(inside) || inside.overlaps(there));
    }
    EXPECT_FALSE(box_at(far, 0.01).overlaps(box_at(-far, 0.01)));
  }
}

TEST(VertexBox, What_is_not_a_number_is_everywhere_and_what_is_nowhere_meets_nothing) {
  const BoxFrame frame(Vec3::Zero(), Vec3::Ones());
  const double nan = std::nan("");
  const BoxLanes everywhere = BoxLanes::load(frame.swept(Vec3(nan, nan, nan), Vec3(nan, nan, nan), 0.1));
  const BoxLanes nowhere = BoxLanes::load(VertexBox::nowhere());
  for (const double x : {0.5, -20.0, 20.0}) {
    const BoxLanes box = BoxLanes::load(frame.swept(Vec3(x, x, x), Vec3(x, x, x), 0.001));
    EXPECT_TRUE(everywhere.overlaps(box) && box.overlaps(everywhere));
    EXPECT_FALSE(nowhere.overlaps(box) || box.overlaps(nowhere));
    EXPECT_TRUE(nowhere.join(box).overlaps(box));
  }
  EXPECT_FALSE(nowhere.overlaps(nowhere) || nowhere.overlaps(everywhere));
}

TEST(VertexBox, A_margin_is_no_more_than_the_ball_and_at_most_a_step_less) {
  Dice dice(4);
  for (int trial = 0; trial < 1000; ++trial) {
    const BoxFrame frame(-Vec3::Ones() * dice.uniform(0.01, 5), Vec3::Ones());
    const double r = std::pow(10, dice.uniform(-6, -1));
    const BoxMargin margin = frame.margin(r);
    for (std::size_t k = 0; k < k_box_axes; ++k) {
      const double reach = k < 3 ? r : std::sqrt(3.0) * r;
      EXPECT_LE(margin[k] * frame.step(k), reach);
      EXPECT_GE((margin[k] + 1.01) * frame.step(k), reach);
    }
  }
}

}  // namespace
}  // namespace ft
