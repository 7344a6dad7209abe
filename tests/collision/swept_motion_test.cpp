// What SweptMotion proves holds for every way that it speaks of, and it proves most of what there is to prove.
#include "collision/broad_phase/swept_motion.h"

#include <gtest/gtest.h>

#include "tests/collision/pair_scene.h"

namespace ft {
namespace {

using test::Dice;

struct Case {
  std::array<Vec3, 4> x;
  std::array<Vec3f, 4> d, centre;
  std::array<float, 4> slack;
  VertexWays ways(std::size_t movable) const { return {x, d, centre, std::span(slack).first(movable)}; }
};

/// Features of some centimetres, `apart` from each other, that go as far as they like.
Case random_case(Dice& dice, PairKind kind, double apart) {
  Case out;
  const Vec3 away = apart * dice.direction(), common = dice.cube(0.05);
  for (std::size_t k = 0; k < 4; ++k) {
    const bool first = static_cast<int>(k) < first_feature_size(kind);
    out.x[k] = dice.cube(0.02) + (first ? away : Vec3::Zero());
    out.d[k] = (common + dice.cube(0.02)).cast<float>();
    out.centre[k] = out.d[k] + dice.cube(0.004).cast<float>();
    out.slack[k] = static_cast<float>(dice.uniform(0, 0.004));
  }
  return out;
}

constexpr Stencil k_all{{0, 1, 2, 3}};

TEST(SweptMotion, What_is_apart_keeps_apart_on_its_way_and_wherever_it_ends) {
  Dice dice(1);
  int found = 0, clear = 0;
  constexpr double k_radius = 0.003, k_keep = 1e-4;
  for (int trial = 0; trial < 20000; ++trial) {
    for (const PairKind kind : {PairKind::k_vertex_face, PairKind::k_edge_edge}) {
      const std::size_t movable = trial % 3 == 0 ? 4 : trial % 3 == 1 ? at(first_feature_size(kind)) : 0;
      const Case c = random_case(dice, kind, dice.uniform(0, 0.08));
      const SweptMotion way(kind, k_all, c.ways(movable), k_radius, k_keep);
      const SweptMotion::Verdict verdict =
          std::max({way.judge(way.between_centres()), way.judge(way.flat()), way.judge(way.between_last_centres())});
      if (verdict == SweptMotion::Verdict::k_open) continue;
      (verdict == SweptMotion::Verdict::k_apart ? found : clear)++;
      const auto moved = [&](double t) {
        std::array<Vec3, 4> at_t;
        for (std::size_t k = 0; k < 4; ++k) at_t[k] = c.x[k] + t * c.d[k].cast<double>();
        return at_t;
      };
      for (int step = 0; step <= 8; ++step) EXPECT_GT(pair_geometry(kind, moved(step / 8.0)).distance, k_keep);
      if (verdict != SweptMotion::Verdict::k_apart) continue;
      for (int step = 0; step < 8; ++step) {
        std::array<Vec3, 4> last;
        for (std::size_t k = 0; k < 4; ++k)
          last[k] =
              c.x[k] + c.centre[k].cast<double>() + (k < movable ? Vec3(c.slack[k] * dice.direction()) : Vec3(0, 0, 0));
        EXPECT_GT(pair_geometry(kind, last).distance, k_radius - 1e-15);
      }
    }
  }
  EXPECT_GT(found, 5000);
  EXPECT_GT(clear, 500);
}

TEST(SweptMotion, Cloth_that_glides_along_a_face_at_a_distance_is_apart_however_far_it_goes) {
  for (const double way_length : {0.001, 0.1, 10.0}) {
    Case c;
    c.x = {Vec3(0.001, 0.01, 0), Vec3(0, 0, 0), Vec3(0.02, 0, 0), Vec3(0, 0, -0.02)};
    c.d = {Vec3(way_length, 0, 0.3 * way_length).cast<float>(), Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero()};
    c.centre = c.d;
    c.slack = {0.004, 0, 0, 0};
    const SweptMotion way(PairKind::k_vertex_face, k_all, c.ways(1), 0.003, 1e-4);
    EXPECT_EQ(way.judge(way.flat()), SweptMotion::Verdict::k_apart);
    const SweptMotion thicker(PairKind::k_vertex_face, k_all, c.ways(1), 0.0061, 1e-4);
    EXPECT_EQ(thicker.judge(thicker.flat()), SweptMotion::Verdict::k_clear);
  }
}

TEST(SweptMotion, Its_flat_normal_is_that_of_the_pair) {
  Dice dice(2);
  for (int trial = 0; trial < 100; ++trial)
    for (const PairKind kind : {PairKind::k_vertex_face, PairKind::k_edge_edge}) {
      const Case c = random_case(dice, kind, 0.01);
      EXPECT_LT((SweptMotion(kind, k_all, c.ways(4), 0, 0).flat() - flat_normal(kind, c.x)).norm(), 1e-15);
    }
}

TEST(SweptMotion, Nothing_is_proved_of_what_is_not_a_number_and_without_a_normal) {
  Dice dice(3);
  Case c = random_case(dice, PairKind::k_edge_edge, 1);
  const SweptMotion sound(PairKind::k_edge_edge, k_all, c.ways(4), 0.001, 0);
  EXPECT_EQ(sound.judge(sound.between_centres()), SweptMotion::Verdict::k_apart);
  EXPECT_EQ(sound.judge(Vec3::Zero()), SweptMotion::Verdict::k_open);
  c.d[2].y() = std::nanf("");
  const SweptMotion unsound(PairKind::k_edge_edge, k_all, c.ways(4), 0.001, 0);
  EXPECT_EQ(unsound.judge(unsound.between_centres()), SweptMotion::Verdict::k_open);
}

}  // namespace
}  // namespace ft
