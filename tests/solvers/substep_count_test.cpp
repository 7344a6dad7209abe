// How many substeps a frame takes for a body that comes along.
#include "solvers/cloth/advance/substep_count.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr double k_side = 0.2, k_frame = 1. / 24, k_way = 0.06;

/// For a sheet of cells x cells at rest, in whose middle the body moves by `way`.
int substeps(int cells, double way) {
  ClothSetup setup;
  setup.preroll_frames = 0;
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = make_sheet(k_side, cells, 0);
  setup.garments.push_back(std::move(sheet));
  const auto model = build_cloth_model(std::move(setup));
  EXPECT_TRUE(model);
  ClothMotion motion;
  motion.x = (*model)->start;
  motion.v.assign(motion.x.size(), Vec3::Zero());
  const std::vector<Vec3> from{Vec3::Zero()}, to{Vec3(way, 0, 0)};
  return substep_count(**model, motion, k_frame, from, to);
}

TEST(SubstepCount, Of_a_fast_body_is_that_of_its_way_in_contact_radii) {
  const ClothSetup setup;
  const int of_way = static_cast<int>(std::ceil(k_way / (setup.travel * ClothGarment{}.thickness)));
  EXPECT_GT(of_way, setup.min_substeps);
  EXPECT_EQ(substeps(8, k_way), of_way);
  EXPECT_EQ(substeps(8, 0.001), setup.min_substeps);
  EXPECT_EQ(substeps(8, 10), setup.max_substeps);
}

TEST(SubstepCount, Of_cloth_finer_than_its_contact_is_that_of_the_way_in_edges) {
  const int fine = substeps(80, k_way);
  EXPECT_GT(fine, substeps(8, k_way));
  EXPECT_NEAR(substeps(160, k_way), 2 * fine, 1);
}

TEST(SubstepCount, What_is_faster_than_the_substeps_can_follow_is_slowed_down_and_nothing_else) {
  ClothSetup setup;
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = make_sheet(k_side, 10, 0);
  setup.garments.push_back(std::move(sheet));
  const auto model = build_cloth_model(std::move(setup));
  ASSERT_TRUE(model);
  const double h = 1e-3;
  const Vec3 common(50, 0, 0);
  ClothMotion motion;
  motion.x = (*model)->start;
  motion.v.assign(motion.x.size(), common);
  EXPECT_FALSE(slow_down(**model, h, motion)) << "all of it goes the same way";
  motion.v[7] += Vec3(0, 1000, 0);
  EXPECT_TRUE(slow_down(**model, h, motion));
  const Vec3 mean = common + Vec3(0, 1000, 0) / static_cast<double>(motion.v.size());
  EXPECT_LT((motion.v[7] - mean).norm() * h, 0.1);
  EXPECT_GT((motion.v[7] - mean).norm() * h, k_side / 10);
  EXPECT_EQ(motion.v[8], common);
}

}  // namespace
}  // namespace ft
