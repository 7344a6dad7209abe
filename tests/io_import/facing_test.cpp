// Bodies that are inside out are turned, piece by piece, and that is said.
#include "io/import/repair/facing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "baker/core/file.h"
#include "baker/core/shapes.h"
#include "baker/core/volume.h"
#include "io/import/import.h"
#include "io/shot/mesh_file.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

/// Pieces beside each other; of these the triangles are turned.
TriangleSurface pieces(const std::vector<std::pair<TriangleSurface, bool>>& all) {
  TriangleSurface out;
  double x = 0;
  for (const auto& [piece, turned] : all) {
    const int first = static_cast<int>(out.positions.size());
    for (const Vec3& p : piece.positions) out.positions.push_back(p + Vec3(x, 1, 0));
    for (const Triangle& t : piece.triangles)
      out.triangles.push_back(turned ? Triangle{t[0] + first, t[2] + first, t[1] + first}
                                     : Triangle{t[0] + first, t[1] + first, t[2] + first});
    x += 3;
  }
  return out;
}

TEST(Facing, A_body_that_faces_outwards_stays_as_it_is) {
  TriangleSurface ball = sphere_surface(0.5, 3);
  const auto before = ball.triangles;
  const FacingReport report = turn_outwards(ball.positions, ball.triangles);
  EXPECT_EQ(report.piece_count, 1);
  EXPECT_TRUE(report.notes().empty());
  EXPECT_EQ(ball.triangles, before);
}

TEST(Facing, One_that_is_inside_out_is_turned_and_has_the_volume_of_the_other) {
  TriangleSurface ball = pieces({{sphere_surface(0.5, 3), true}});
  EXPECT_FALSE(enclosed_volume(ball.positions, ball.triangles, 0.02));
  const FacingReport report = turn_outwards(ball.positions, ball.triangles);
  EXPECT_EQ(report.notes(),
            std::vector<std::string>{"its surface is inside out (its faces point into the 0.511 m3 that "
                                     "they enclose): turned"});
  EXPECT_TRUE(enclosed_volume(ball.positions, ball.triangles, 0.02));
}

TEST(Facing, Split_vertices_are_no_rims) {
  const TriangleSurface ball = pieces({{sphere_surface(0.5, 3), true}});
  TriangleSurface soup;
  for (const Triangle& t : ball.triangles) {
    const int first = static_cast<int>(soup.positions.size());
    for (const int v : t) soup.positions.push_back(ball.positions[at(v)]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(turn_outwards(soup.positions, soup.triangles).turned_count, 1);
  EXPECT_TRUE(enclosed_volume(soup.positions, soup.triangles, 0.02));
}

TEST(Facing, Pieces_are_turned_one_by_one) {
  const std::vector<std::pair<TriangleSurface, bool>> good = {
      {sphere_surface(0.5, 2), false}, {box_surface(Vec3(1, 0.2, 0.1)), false}, {capsule_surface(0.01, 1, 2), false}};
  auto bad = good;
  bad[1].second = bad[2].second = true;
  TriangleSurface surface = pieces(bad);
  const FacingReport report = turn_outwards(surface.positions, surface.triangles);
  EXPECT_EQ(report.piece_count, 3);
  EXPECT_EQ(report.turned_count, 2);
  ASSERT_EQ(report.notes().size(), 1u);
  EXPECT_EQ(report.notes()[0].rfind("2 of its 3 closed pieces are inside out", 0), 0u) << report.notes()[0];
  EXPECT_EQ(surface.triangles, pieces(good).triangles);
}

TEST(Facing, A_cut_at_the_neck_does_not_hide_it_and_a_sheet_has_no_inside) {
  TriangleSurface ball = pieces({{sphere_surface(0.5, 4), true}});
  ball.triangles.resize(ball.triangles.size() - 8);
  EXPECT_EQ(turn_outwards(ball.positions, ball.triangles).turned_count, 1);
  TriangleSurface sheet = pieces({{box_surface(Vec3(1, 1, 1)), true}});
  sheet.triangles.resize(2);
  EXPECT_EQ(turn_outwards(sheet.positions, sheet.triangles).piece_count, 0);
}

/// Winds every triangle whose middle is where `there` says the other way.
template <class There>
int wind_back(TriangleSurface& surface, There there) {
  int out = 0;
  for (Triangle& t : surface.triangles) {
    const Vec3 middle = (surface.positions[at(t[0])] + surface.positions[at(t[1])] + surface.positions[at(t[2])]) / 3;
    if (there(middle)) std::swap(t[1], t[2]), ++out;
  }
  return out;
}

/// As sets: a turned triangle may begin elsewhere.
std::vector<Triangle> from_lowest(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return triangles;
}

TEST(Facing, Faces_of_a_piece_are_made_to_agree_and_to_face_outwards) {
  const auto anywhere = [](const Vec3&) { return true; };
  const auto half = [](const Vec3& p) { return p.x() < 0; };
  const auto most = [](const Vec3& p) { return p.x() < 0.3; };
  const auto spot = [](const Vec3& p) { return p.x() < -0.4 && p.y() > 0; };
  const auto scattered = [](const Vec3& p) { return std::fmod(std::abs(7919 * p.x() + 104729 * p.y()), 1.0) < 0.5; };
  const TriangleSurface good[] = {sphere_surface(0.5, 3), box_surface(Vec3(1, 0.8, 0.9)), capsule_surface(0.5, 1, 3)};
  for (const TriangleSurface& right : good) {
    int n = 0;
    const auto check = [&](auto there) {
      TriangleSurface surface = right;
      const int back = wind_back(surface, there);
      const FacingReport report = turn_outwards(surface.positions, surface.triangles);
      EXPECT_EQ(from_lowest(surface.triangles), from_lowest(right.triangles)) << n;
      const bool all = back == static_cast<int>(right.triangles.size());
      EXPECT_EQ(report.disagreeing_turned, back > 0 && !all ? back : 0) << n;
      EXPECT_EQ(report.notes().size(), back > 0 ? 1u : 0u) << n;
      ++n;
    };
    check(anywhere), check(half), check(most), check(spot), check(scattered);
  }
}

TEST(Facing, Half_of_an_open_body_is_turned_and_the_rim_does_not_count) {
  TriangleSurface ball = sphere_surface(0.5, 4);
  ball.triangles.resize(ball.triangles.size() - 40);
  const auto right = from_lowest(ball.triangles);
  const int back = wind_back(ball, [](const Vec3& p) { return p.y() < 0.1; });
  const FacingReport report = turn_outwards(ball.positions, ball.triangles);
  EXPECT_EQ(report.disagreeing_turned, back);
  EXPECT_EQ(from_lowest(ball.triangles), right);
}

TEST(Facing, Two_boxes_that_share_an_edge_are_two_shells) {
  TriangleSurface boxes = box_surface(Vec3(1, 1, 1));
  const TriangleSurface other = boxes;
  std::vector<int> number(other.positions.size());
  for (std::size_t v = 0; v < other.positions.size(); ++v) {
    const Vec3 p = other.positions[v] + Vec3(1, 1, 0);
    const auto same = std::find_if(boxes.positions.begin(), boxes.positions.end(),
                                   [&](const Vec3& q) { return (p - q).norm() < 1e-9; });
    number[v] = static_cast<int>(same - boxes.positions.begin());
    if (same == boxes.positions.end()) boxes.positions.push_back(p);
  }
  const auto add = [&](TriangleSurface& to, bool back) {
    for (const Triangle& t : other.triangles)
      to.triangles.push_back({number[at(t[0])], number[at(t[back ? 2 : 1])], number[at(t[back ? 1 : 2])]});
  };
  TriangleSurface right = boxes;
  add(boxes, true), add(right, false);
  EXPECT_EQ(turn_outwards(boxes.positions, boxes.triangles).turned_count, 1);
  EXPECT_EQ(from_lowest(boxes.triangles), from_lowest(right.triangles));
}

TEST(Facing, A_Moebius_strip_has_no_outside_and_is_named) {
  TriangleSurface strip;
  constexpr int k_count = 24;
  for (int i = 0; i < k_count; ++i) {
    const double along = 2 * std::numbers::pi * i / k_count;
    for (const double side : {-0.1, 0.1}) {
      const double r = 0.5 + side * std::cos(0.5 * along);
      strip.positions.push_back({r * std::cos(along), side * std::sin(0.5 * along), r * std::sin(along)});
    }
  }
  for (int i = 0; i < k_count; ++i) {
    const bool last = i + 1 == k_count;
    const int a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangles.push_back({a, b, c});
    strip.triangles.push_back({c, b, d});
  }
  const auto before = strip.triangles;
  const FacingReport report = turn_outwards(strip.positions, strip.triangles);
  EXPECT_EQ(report.one_sided_count, 1);
  EXPECT_EQ(strip.triangles, before);
  ASSERT_EQ(report.notes().size(), 1u);
  EXPECT_NE(report.notes()[0].find("Moebius"), std::string::npos) << report.notes()[0];
}

TEST(Facing, A_sheet_whose_faces_disagree_takes_the_side_of_the_larger_part) {
  TriangleSurface sheet = box_surface(Vec3(1, 1, 1));
  sheet.triangles.resize(4);
  const auto right = from_lowest(sheet.triangles);
  std::swap(sheet.triangles[1][0], sheet.triangles[1][1]);
  EXPECT_EQ(turn_outwards(sheet.positions, sheet.triangles).disagreeing_turned, 1);
  EXPECT_EQ(from_lowest(sheet.triangles), right);
}

TEST(Facing, An_import_turns_the_surface_and_says_so) {
  const test::ScratchFolder scratch;
  const TriangleSurface ball = pieces({{sphere_surface(0.5, 2), true}});
  ASSERT_TRUE(write_obj(scratch / "ball.obj", make_triangle_mesh("ball", ball.positions, ball.triangles)).ok());
  ImportRequest request;
  request.file = scratch / "ball.obj";
  const auto imported = import_primary(request);
  ASSERT_TRUE(imported) << imported.error().text();
  ASSERT_FALSE(imported->info.notes.empty());
  EXPECT_EQ(imported->info.notes[0].rfind("its surface is inside out", 0), 0u) << imported->info.notes[0];
  std::vector<Vec3> x(ball.positions.size());
  imported->trajectory->bind_pose(x);
  EXPECT_EQ(x[5], ball.positions[5].cast<float>().cast<double>());
  EXPECT_TRUE(enclosed_volume(x, imported->trajectory->surface().triangles, 0.02));
}

}  // namespace
}  // namespace ft
