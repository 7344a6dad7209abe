// What a frame may cost, whatever the body does: torn bodies are not met, and work is limited.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "solvers/cloth/advance/work_limit.h"
#include "solvers/cloth/cloth_solver.h"
#include "solvers/cloth/model/torn_body.h"
#include "tests/support/scripted_body.h"
#include "tests/support/torture/shapes.h"

namespace ft {
namespace {

TEST(WorkLimit, What_is_spent_is_gone_and_what_follows_keeps_its_own) {
  WorkLimit limit(32, false);
  const double all = limit.patience(0);
  EXPECT_GT(all, 200);
  EXPECT_LT(limit.patience(31), all);
  EXPECT_LT(WorkLimit(32, true).patience(0), all);
  limit.spend(all);
  EXPECT_LE(limit.patience(0), 0);
}

TEST(WorkLimit, Counts_pairs_where_there_are_very_many) {
  EXPECT_EQ(WorkLimit::of_search(4000, 1000), 1);
  EXPECT_EQ(WorkLimit::of_search(0, 0), 1);
  EXPECT_GT(WorkLimit::of_iteration(10'000'000, 1000), 100);
}

/// Two balls, of which the second goes `way` in the frames -1, 0 and 1, each.
std::vector<char> torn_second_ball(std::array<double, 3> way) {
  std::vector<Vec3> bind;
  std::vector<Triangle> triangles;
  make_sphere(0.2, 6, 8, bind, triangles);
  const auto half = static_cast<std::ptrdiff_t>(bind.size());
  make_sphere(0.1, 5, 6, bind, triangles);
  std::vector<int> part(bind.size(), 0);
  std::fill(part.begin() + half, part.end(), 1);
  const auto at_place = [&](double x) {
    std::vector<Vec3> out = bind;
    for (std::size_t i = at(static_cast<int>(half)); i < out.size(); ++i) out[i].x() += x;
    return out;
  };
  const TornBody body(bind, triangles, part);
  const std::vector<char> torn = body.find(at_place(0), at_place(way[1]), [&](int which) {
    return which < 0 ? at_place(-way[0]) : at_place(way[1] + way[2]);
  });
  if (!torn.empty()) {
    EXPECT_EQ(std::count(torn.begin(), torn.begin() + half, char{1}), 0) << "it stands still";
  }
  return torn;
}

TEST(TornBody, What_leaps_and_neither_comes_nor_goes_on_is_torn) {
  const std::vector<char> torn = torn_second_ball({0, 2, 0});
  ASSERT_FALSE(torn.empty());
  EXPECT_EQ(torn.back(), 1);
}

TEST(TornBody, What_is_quick_and_real_is_not) {
  EXPECT_TRUE(torn_second_ball({0, 0.5, 0}).empty());
  EXPECT_TRUE(torn_second_ball({2, 2, 0}).empty()) << "it stops";
  EXPECT_TRUE(torn_second_ball({0, 2, 2}).empty()) << "it starts";
}

TEST(TornBody, Skin_over_a_gap_is_torn) {
  const std::vector<Vec3> bind = {{0, 0, 0}, {0.02, 0, 0}, {0, 0.02, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  const std::vector<int> part(3, 0);
  const TornBody body(bind, triangles, part);
  const auto none = [&](int) { return bind; };
  EXPECT_TRUE(body.find(bind, bind, none).empty());
  std::vector<Vec3> apart = bind;
  apart[1].x() = 0.5;
  EXPECT_FALSE(body.find(bind, apart, none).empty());
  apart[1].x() = 0.09;
  EXPECT_TRUE(body.find(apart, apart, none).empty()) << "an arm of rubber";
}

/// A sheet that hangs among balls, of which each is elsewhere in every frame.
ClothSetup among_leaping_balls() {
  torture::RigidParts body;
  body.add("stand", torture::box({0.5, 0.02, 0.5}), [](double) { return torture::shift({0, -0.7, 0}); });
  for (int ball = 0; ball < 6; ++ball)
    body.add("ball" + std::to_string(ball), torture::box({0.12, 0.12, 0.12}), [ball](double t) {
      const auto place = [ball](int frame) {
        const double angle = 2.4 * frame + 1.05 * ball;
        return Vec3(std::cos(angle), 0.25 * std::sin(1.7 * frame + ball), std::sin(2.1 * angle));
      };
      const double frame = std::floor(24 * t), share = 24 * t - frame;
      const Vec3 from = place(static_cast<int>(frame)), to = place(static_cast<int>(frame) + 1);
      return torture::shift((1 - share) * from + share * to);
    });
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = make_sheet(0.6, 24, 0.3);
  ClothPin pin;
  for (int i = 0; i <= 24; ++i) pin.vertices.push_back(i);
  pin.to_world = true;
  sheet.pins.push_back(pin);
  ClothSetup setup;
  setup.primary = body.build();
  setup.preroll_frames = 0;
  setup.fps = 24;
  setup.garments.push_back(std::move(sheet));
  return setup;
}

TEST(BoundedFrames, Parts_that_leap_do_not_sweep_through_the_cloth) {
  auto solver = make_cloth_solver(among_leaping_balls());
  ASSERT_TRUE(solver) << solver.error().text();
  State state = (*solver)->initial_state();
  bool told = false;
  for (int f = 0; f < 10; ++f) {
    const FrameReport r = (*solver)->advance_frame(state);
    EXPECT_TRUE(r.finite);
    EXPECT_LT(r.newton_iterations, 60) << r.frame;
    EXPECT_EQ(r.crossings_body + r.crossings_self, 0) << r.frame;
    for (const Incident& i : r.incidents) told = told || i.text.find("torn") != std::string::npos;
  }
  EXPECT_TRUE(told);
}

TEST(BoundedFrames, Cloth_that_is_slowed_down_is_told_with_what_would_follow_it) {
  ClothSetup setup;
  setup.preroll_frames = 0;
  setup.min_substeps = setup.max_substeps = 2;
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = make_sheet(0.6, 12, 0.3);
  setup.garments.push_back(std::move(sheet));
  auto solver = make_cloth_solver(setup);
  ASSERT_TRUE(solver) << solver.error().text();
  State calm = (*solver)->initial_state(), fast = calm;
  EXPECT_TRUE((*solver)->advance_frame(calm).incidents.empty());
  fast.block("v")[3 * 40 + 2] = 500;  // m/s, of one vertex
  const FrameReport report = (*solver)->advance_frame(fast);
  ASSERT_FALSE(report.incidents.empty());
  EXPECT_EQ(report.incidents[0].kind, Incident::Kind::k_cut_short);
  EXPECT_NE(report.incidents[0].text.find("max_substeps"), std::string::npos) << report.incidents[0].text;
}

}  // namespace
}  // namespace ft
