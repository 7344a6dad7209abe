// Vertices of body caches that leave the body for a few samples, or are no numbers there: put back, named; and what
// moves wildly and is right stays as it is, to the bit.
#include "io/import/repair/stray_vertices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/import/files/read_geometry_cache.h"
#include "tests/support/assets.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr int k_samples = 40;
constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();

/// A ball of 1 m that tumbles, bobs and breathes: a vertex is 3 cm off the way between its places before and after.
GeometryCache tumbling_ball(int samples = k_samples) {
  GeometryCache out;
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  make_sphere(0.5, 16, 24, points, triangles);
  out.mesh = make_triangle_mesh("ball", points, triangles);
  out.vertex_count = out.mesh.vertex_count();
  for (int s = 0; s < samples; ++s) {
    const double t = s / 25.0;
    out.times.push_back(t);
    const Mat3 turn = (Eigen::AngleAxisd(9 * t, Vec3(1, 2, 0.5).normalized())).toRotationMatrix();
    for (const Vec3& p : points)
      out.positions.push_back(
          ((1 + 0.1 * std::sin(7 * t)) * (turn * p) + Vec3(2 * t, std::sin(9 * t), 0)).cast<float>());
  }
  return out;
}

Vec3f& vertex(GeometryCache& cache, int sample, int v) {
  return cache.positions[at(sample) * at(cache.vertex_count) + at(v)];
}

/// Farthest that a position is from where it was before it was broken [m].
double difference(const GeometryCache& a, const GeometryCache& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    const double d = static_cast<double>((a.positions[i] - b.positions[i]).norm());
    if (!(d <= worst)) worst = d;
  }
  return worst;
}

std::string notes_of(const std::vector<StrayVertex>& strays) {
  std::string out;
  for (const std::string& note : stray_notes(strays, "ball.pc2", 1, [](int sample) { return 1001.0 + sample; }))
    out += note + "\n";
  return out;
}

TEST(StrayVertices, One_that_is_metres_away_for_a_sample_goes_back_among_its_neighbours) {
  const GeometryCache good = tumbling_ball();
  for (const int sample : {0, 1, 17, k_samples - 1}) {
    GeometryCache cache = good;
    vertex(cache, sample, 100) += Vec3f(0, 3, 0);
    const auto strays = mend_stray_vertices(cache, "ball.pc2");
    ASSERT_TRUE(strays) << strays.error().text();
    ASSERT_EQ(strays->size(), 1u);
    EXPECT_NEAR(strays->front().distance, 3, 0.1);
    EXPECT_LT(difference(cache, good), 0.02) << sample;  // turned by 21 degrees between its samples
    const std::string frame = std::to_string(1001 + sample), number = std::to_string(sample);
    EXPECT_NE(notes_of(*strays).find("ball.pc2: vertex 100 is up to "), std::string::npos) << notes_of(*strays);
    EXPECT_NE(notes_of(*strays).find("at frame " + frame + " (sample " + number + " of the file): put back"),
              std::string::npos)
        << notes_of(*strays);
  }
}

TEST(StrayVertices, What_is_no_number_for_some_samples_is_mended_alike) {
  const GeometryCache good = tumbling_ball();
  for (const float bad : {k_nan, std::numeric_limits<float>::infinity(), 3e9f}) {
    GeometryCache cache = good;
    for (int s = 10; s < 13; ++s) vertex(cache, s, 7).y() = bad;
    const auto strays = mend_stray_vertices(cache, "ball.pc2");
    ASSERT_TRUE(strays) << strays.error().text();
    EXPECT_LT(difference(cache, good), 0.03);
    EXPECT_EQ(notes_of(*strays),
              "ball.pc2: vertex 7 has no finite position at frames 1011 to 1013 (samples 10 to 12 of "
              "the file): put back among its neighbours\n");
  }
}

TEST(StrayVertices, Neighbours_that_stray_together_are_mended_from_their_rim_inwards) {
  const GeometryCache good = tumbling_ball();
  GeometryCache cache = good;
  const auto edges = unique_edges(triangulate(cache.mesh));
  const Adjacency neighbours = vertex_neighbours(at(cache.vertex_count), edges);
  vertex(cache, 20, 150).x() = k_nan;
  for (const int n : neighbours.row(150)) vertex(cache, 20, n).x() = k_nan;
  ASSERT_TRUE(mend_stray_vertices(cache, "ball.pc2"));
  EXPECT_LT(difference(cache, good), 0.03);
}

TEST(StrayVertices, A_sample_without_any_finite_position_is_bridged) {
  const GeometryCache good = tumbling_ball();
  GeometryCache cache = good;
  for (int v = 0; v < cache.vertex_count; ++v) vertex(cache, 20, v).x() = k_nan;
  const auto strays = mend_stray_vertices(cache, "ball.pc2");
  ASSERT_TRUE(strays) << strays.error().text();
  EXPECT_LT(difference(cache, good), 0.1);
  EXPECT_NE(notes_of(*strays).find("362 vertices (0, 1, 2, ...) have no finite positions at frame 1021"),
            std::string::npos)
      << notes_of(*strays);
}

TEST(StrayVertices, What_is_no_number_for_long_is_refused_by_name) {
  for (const auto& [first, last] : {std::pair{0, k_samples - 1}, {5, 20}}) {
    GeometryCache cache = tumbling_ball();
    for (int s = first; s <= last; ++s) vertex(cache, s, 7).y() = k_nan;
    const auto strays = mend_stray_vertices(cache, "ball.pc2");
    ASSERT_FALSE(strays);
    EXPECT_NE(strays.error().text().find("ball.pc2: vertex 7 is not a finite position"), std::string::npos);
    EXPECT_NE(strays.error().text().find("in samples " + std::to_string(first) + " to " + std::to_string(last)),
              std::string::npos)
        << strays.error().text();
  }
  GeometryCache still = tumbling_ball(1);
  vertex(still, 0, 7).y() = k_nan;
  EXPECT_FALSE(mend_stray_vertices(still, "ball.pc2"));
}

TEST(StrayVertices, What_is_away_for_long_is_named_and_left) {
  const GeometryCache good = tumbling_ball();
  GeometryCache cache = good;
  for (int s = 10; s < 20; ++s) vertex(cache, s, 7) += Vec3f(3, 0, 0);
  const GeometryCache before = cache;
  const auto strays = mend_stray_vertices(cache, "ball.pc2");
  ASSERT_TRUE(strays);
  EXPECT_EQ(difference(cache, before), 0);
  EXPECT_EQ(notes_of(*strays),
            "ball.pc2: vertex 7 is away from its neighbours at frames 1011 to 1020 (samples 10 to 19 "
            "of the file): for too long to be mended; look at these frames\n");
}

TEST(StrayVertices, Bodies_that_jump_kick_and_grow_stay_as_they_are) {
  GeometryCache cache = tumbling_ball();
  for (int v = 0; v < cache.vertex_count; ++v) {
    vertex(cache, 11, v) += Vec3f(5, 0, 0);  // a cut, and back
    vertex(cache, 21, v) *= 4;
    // Half of it is drawn out for a sample, as a limb of rubber is.
    if (cache.mesh.positions[at(v)].y() > 0) vertex(cache, 31, v) += Vec3f(0, 0.1f, 0);
  }
  const GeometryCache before = cache;
  const auto strays = mend_stray_vertices(cache, "ball.pc2");
  ASSERT_TRUE(strays);
  EXPECT_EQ(notes_of(*strays), "");
  EXPECT_EQ(difference(cache, before), 0);
}

TEST(StrayVertices, A_real_dancer_has_none_and_a_broken_one_gets_her_vertex_back) {
  const auto folder = test::assets_root() / "garments/cipc_mannequin_rumba";
  FT_REQUIRE_FILE(folder / "rumba_body_121f.pc2");
  auto dancer = read_geometry_cache(folder / "rumba_body_121f.pc2", folder / "body_frame0_yup.obj", 25);
  ASSERT_TRUE(dancer) << dancer.error().text();
  EXPECT_EQ(notes_of(dancer->strays), "");
  GeometryCache broken = *dancer;
  for (int v = 100; v < broken.vertex_count; v += 997) vertex(broken, v % 121, v) += Vec3f(0, 0, -2);
  const auto strays = mend_stray_vertices(broken, "rumba");
  ASSERT_TRUE(strays);
  EXPECT_EQ(strays->size(), 13u);
  EXPECT_LT(difference(broken, *dancer), 2e-3);  // edges are 10 mm
}

}  // namespace
}  // namespace ft
