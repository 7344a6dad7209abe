// Which geometry caches are sheets: by how large their openings are.
#include "io/import/motion/sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "io/import/import.h"
#include "io/shot/mesh_file.h"
#include "tests/support/assets.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr double k_pi = std::numbers::pi;

/// Around y, without ends.
void tube(double radius, double height, std::vector<Vec3>& x, std::vector<Triangle>& t) {
  constexpr int k_rings = 16, k_segments = 48;
  for (int r = 0; r <= k_rings; ++r)
    for (int s = 0; s < k_segments; ++s) {
      const double a = 2 * k_pi * s / k_segments;
      x.emplace_back(radius * std::cos(a), height * r / k_rings, radius * std::sin(a));
    }
  const auto v = [&](int r, int s) { return r * k_segments + s % k_segments; };
  for (int r = 0; r < k_rings; ++r)
    for (int s = 0; s < k_segments; ++s) {
      t.push_back({v(r, s), v(r + 1, s), v(r, s + 1)});
      t.push_back({v(r + 1, s), v(r + 1, s + 1), v(r, s + 1)});
    }
}

TEST(Openings, Of_a_tube_they_are_its_two_ends) {
  std::vector<Vec3> x;
  std::vector<Triangle> t;
  tube(0.3, 1, x, t);
  const Openings open = openings_of(x, t);
  EXPECT_NEAR(open.area, 2 * k_pi * 0.09, 0.01);
  EXPECT_NEAR(open.surface, 2 * k_pi * 0.3, 0.01);
}

TEST(Openings, A_flat_cloth_is_all_opening) {
  const Mesh sheet = make_sheet(0.5, 6, 1);
  EXPECT_NEAR(openings_of(sheet.positions, triangulate(sheet)).share(), 1, 1e-9);
}

TEST(Openings, A_seam_whose_edges_lie_on_each_other_is_none) {
  std::vector<Vec3> x;
  std::vector<Triangle> t;
  make_sphere(0.3, 12, 24, x, t);
  EXPECT_EQ(openings_of(x, t).area, 0);
  std::vector<Vec3> apart;  // every triangle has corners of its own
  std::vector<Triangle> own;
  for (const Triangle& triangle : t) {
    const int first = static_cast<int>(apart.size());
    for (const int v : triangle) apart.push_back(x[at(v)]);
    own.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(openings_of(apart, own).area, 0);
}

class Sheets : public testing::Test {
 protected:
  SurfacePart part_of(const Mesh& mesh, const std::string& surface, std::string* notes = nullptr) {
    EXPECT_TRUE(write_obj(folder_ / "cache.obj", mesh).ok());
    ImportRequest request;
    request.file = folder_ / "cache.obj";
    request.surface = surface;
    auto primary = import_primary(request);
    EXPECT_TRUE(primary) << primary.error().text();
    if (notes)
      for (const std::string& note : primary->info.notes) *notes += note + "\n";
    return primary->trajectory->surface().parts.at(0);
  }
  test::ScratchFolder folder_;
};

TEST_F(Sheets, An_open_cache_is_one_and_says_so_and_the_shot_file_has_the_last_word) {
  std::vector<Vec3> x;
  std::vector<Triangle> t;
  tube(0.3, 1, x, t);
  const Mesh robe = make_triangle_mesh("robe", x, t);
  std::string notes;
  EXPECT_TRUE(part_of(robe, "", &notes).sheet);
  EXPECT_NE(notes.find("it is taken as a sheet"), std::string::npos) << notes;
  EXPECT_EQ(part_of(robe, "").size, 0) << "it is never the larger part";
  EXPECT_FALSE(part_of(robe, "solid").sheet);
}

TEST_F(Sheets, A_body_with_a_small_hole_is_none_and_says_so) {
  std::vector<Vec3> x;
  std::vector<Triangle> t;
  make_sphere(0.3, 24, 48, x, t);
  std::string notes;
  EXPECT_FALSE(part_of(make_triangle_mesh("ball", x, t), "", &notes).sheet);
  EXPECT_EQ(notes.find("open"), std::string::npos) << notes;
  std::erase_if(t, [&](const Triangle& triangle) {
    return std::any_of(triangle.begin(), triangle.end(), [&](int v) { return x[at(v)].y() > 0.295; });
  });
  notes.clear();
  EXPECT_FALSE(part_of(make_triangle_mesh("ball", x, t), "", &notes).sheet);
  EXPECT_NE(notes.find("it is taken as a body"), std::string::npos) << notes;
  EXPECT_TRUE(part_of(make_triangle_mesh("ball", x, t), "sheet").sheet);
}

}  // namespace
}  // namespace ft
