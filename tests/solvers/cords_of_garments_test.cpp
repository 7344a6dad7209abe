// Nets from the edges of real garments: junctions of any number of cords, open borders, many pieces.
#include <gtest/gtest.h>

#include <numeric>

#include "baker/core/random.h"
#include "io/shot/mesh_file.h"
#include "solvers/cords/generators.h"
#include "solvers/cords/tubes.h"
#include "tests/support/assets.h"
#include "tests/support/cords.h"

namespace ft {
namespace {

class CordsOfGarment : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto file = test::assets_root() / "garments" / GetParam();
    FT_REQUIRE_FILE(file);
    auto read = read_obj(file);
    ASSERT_TRUE(read.ok()) << read.error().text();
    mesh_ = std::move(*read);
  }
  Mesh mesh_;
};

TEST_P(CordsOfGarment, Strands_hold_every_cord_without_sharp_turns_and_weigh_what_was_asked) {
  for (const int pieces : {1, 2}) {
    const auto net = cords_of_mesh(mesh_, "", pieces);
    ASSERT_TRUE(net.ok()) << net.error().text();
    test::expect_strands_hold_every_cord(*net);
    EXPECT_LT(net->strands.size(), net->cords.size() / at(4 * pieces)) << "strands run on through knots";
    for (const auto& strand : net->strands)
      for (std::size_t i = 1; i + 1 < strand.size(); ++i) EXPECT_GT(test::cosine_of_turn(*net, strand, i), 0.24);
    const std::vector<double> masses = lumped_masses(*net, 0.5);
    EXPECT_GT(*std::min_element(masses.begin(), masses.end()), 0);
    EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), 0.5, 1e-12);
  }
}

TEST_P(CordsOfGarment, Tubes_stay_about_their_cords_however_the_points_are_torn_and_crushed) {
  const auto net = cords_of_mesh(mesh_, "", 1);
  ASSERT_TRUE(net.ok()) << net.error().text();
  constexpr double k_radius = 1e-3;
  const CordTubes tubes(*net, k_radius);
  std::vector<Vec3> points, out(tubes.mesh().positions.size());
  for (const Vec3& p : net->points) {
    const RandomKey key{.element = points.size()};
    const Vec3 torn(random_uniform(key, 0), random_uniform(key, 1), random_uniform(key, 2));
    points.push_back(Vec3(p.x(), 0, 0.1 * p.z()) + 0.01 * torn);
  }
  for (std::size_t i = 0; i + 1 < points.size(); i += 5) points[i + 1] = points[i];
  tubes.place(points, out);
  std::size_t v = 0;
  for (const auto& strand : net->strands)
    for (const int point : strand)
      for (int k = 0; k < CordTubes::k_sides; ++k, ++v) {
        const double distance = (out[v] - points[at(point)]).norm();
        ASSERT_GE(distance, k_radius * (1 - 1e-9));
        ASSERT_LE(distance, 2 * k_radius * (1 + 1e-9));
      }
}

INSTANTIATE_TEST_SUITE_P(All, CordsOfGarment,
                         testing::Values("cipc_dress_knife/drape.obj", "cipc_skirts/skirt4K.obj",
                                         "makehuman_clothes/female_elegantsuit01/female_elegantsuit01.obj",
                                         "makehuman_clothes/male_casualsuit01/male_casualsuit01.obj"));

}  // namespace
}  // namespace ft
