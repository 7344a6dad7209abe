// Volumes of shells: against closed forms, overlapping, open, inside out.
#include "baker/core/volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "baker/core/lids.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

struct Shell {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

void add_box(Shell& shell, const Vec3& lo, const Vec3& hi) {
  const int first = static_cast<int>(shell.points.size());
  for (int k = 0; k < 8; ++k)
    shell.points.emplace_back((k & 1) ? hi.x() : lo.x(), (k & 2) ? hi.y() : lo.y(), (k & 4) ? hi.z() : lo.z());
  for (const Triangle& t : std::array<Triangle, 12>{{{0, 2, 3},
                                                     {0, 3, 1},
                                                     {4, 5, 7},
                                                     {4, 7, 6},
                                                     {0, 1, 5},
                                                     {0, 5, 4},
                                                     {2, 6, 7},
                                                     {2, 7, 3},
                                                     {0, 4, 6},
                                                     {0, 6, 2},
                                                     {1, 3, 7},
                                                     {1, 7, 5}}})
    shell.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

TEST(Volume, Of_a_box_and_a_ball_is_what_geometry_says) {
  Shell box;
  add_box(box, {1, 2, 3}, {1.3, 2.5, 3.2});
  EXPECT_NEAR(enclosed_volume(box.points, box.triangles, 1e-3).value(), 0.03, 2e-4);
  Shell ball;
  make_sphere(0.5, 64, 128, ball.points, ball.triangles);
  EXPECT_NEAR(enclosed_volume(ball.points, ball.triangles, 5e-3).value(), std::numbers::pi / 6, 2e-3);
}

TEST(Volume, Of_overlapping_shells_counts_what_they_share_once) {
  Shell boxes;
  add_box(boxes, {0, 0, 0}, {1, 1, 1});
  add_box(boxes, {0.5, 0.2, 0.1}, {1.5, 0.8, 0.9});
  EXPECT_NEAR(enclosed_volume(boxes.points, boxes.triangles, 5e-3).value(), 1 + 0.5 * 0.6 * 0.8, 5e-3);
  EXPECT_LT((volume_centre(boxes.points, boxes.triangles) - Vec3(0.662, 0.5, 0.5)).norm(), 1e-3);
}

TEST(Volume, Of_an_open_body_is_that_with_lids_over_its_rims) {
  Shell box;
  add_box(box, {0, 0, 0}, {1, 2, 0.5});
  for (int face = 0; face < 6; ++face) {  // each in turn, two triangles: flat lids are exact
    Shell open = box;
    open.triangles.erase(open.triangles.begin() + 2 * face, open.triangles.begin() + 2 * face + 2);
    const Lids lids = close_rims(open.points, open.triangles);
    const auto volume = enclosed_volume(open.points, open.triangles, 5e-3);
    if (lids.share() > k_most_open)
      EXPECT_FALSE(volume) << face;
    else
      EXPECT_NEAR(volume.value_or(0), 1, 5e-3) << face;
    EXPECT_EQ(lids.open_edges, 4);
  }
  // A ball with holes at both ends of the columns that measure it.
  Shell ball;
  make_sphere(0.5, 64, 128, ball.points, ball.triangles);
  const double height = 0.45;
  std::erase_if(ball.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](int v) { return std::abs(ball.points[at(v)].y()) > height; });
  });
  double rim = 0;
  for (const Triangle& t : ball.triangles)
    for (const int v : t) rim = std::max(rim, ball.points[at(v)].y());
  const double zone = 2 * std::numbers::pi * (0.25 * rim - rim * rim * rim / 3);
  EXPECT_NEAR(enclosed_volume(ball.points, ball.triangles, 5e-3).value(), zone, 2e-3);
  const Lids lids = close_rims(ball.points, ball.triangles);
  EXPECT_EQ(lids.middles.size(), 2u);
  EXPECT_NEAR(lids.area, 2 * std::numbers::pi * (0.25 - rim * rim), 1e-3);
}

TEST(Volume, Of_a_surface_without_shared_vertices_is_that_of_the_joined_one) {
  Shell box, soup;
  add_box(box, {0, 0, 0}, {1, 1, 1});
  for (const Triangle& t : box.triangles) {
    const int first = static_cast<int>(soup.points.size());
    for (const int v : t) soup.points.push_back(box.points[at(v)]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_NEAR(enclosed_volume(soup.points, soup.triangles, 5e-3).value(), 1, 1e-2);
}

TEST(Volume, Of_what_is_wide_open_or_inside_out_is_not_known) {
  Shell box;
  add_box(box, {0, 0, 0}, {1, 1, 1});
  Shell inside_out = box;
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(enclosed_volume(inside_out.points, inside_out.triangles, 0.01).has_value());
  box.triangles.resize(10);
  Shell open = box;
  open.triangles.erase(open.triangles.begin() + 4, open.triangles.begin() + 6);  // the bottom
  EXPECT_FALSE(enclosed_volume(open.points, open.triangles, 0.01).has_value());
  EXPECT_FALSE(enclosed_volume({}, {}, 0.01).has_value());
}

TEST(Volume, Centre_is_that_of_the_solid_and_not_of_its_vertices) {
  Shell ball;
  make_sphere(0.5, 32, 64, ball.points, ball.triangles);
  for (Vec3& p : ball.points) p += Vec3(3, 2, 1);
  for (int k = 0; k < 1000; ++k) ball.points.push_back(ball.points[0]);  // many vertices at the top, of no triangle
  EXPECT_LT((volume_centre(ball.points, ball.triangles) - Vec3(3, 2, 1)).norm(), 1e-12);
}

}  // namespace
}  // namespace ft
