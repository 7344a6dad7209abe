#include "baker/core/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ft {
namespace {

TEST(Mesh, Of_triangles_alone_is_seen_as_it_is_split_and_else_not) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.5, 0}};
  mesh.face_sizes = {3, 3};
  mesh.face_vertices = {1, 4, 2, 0, 1, 2};
  const auto seen = as_triangles(mesh);
  const std::vector<Triangle> split = triangulate(mesh);
  EXPECT_TRUE(std::equal(seen.begin(), seen.end(), split.begin(), split.end()));
  EXPECT_EQ(seen.size(), 2u);
  mesh.face_sizes = {3, 4};
  mesh.face_vertices = {1, 4, 2, 0, 1, 2, 3};
  EXPECT_TRUE(as_triangles(mesh).empty());
  mesh.face_sizes = {4, 2};  // as many corners as two triangles have
  mesh.face_vertices = {0, 1, 2, 3, 1, 4};
  EXPECT_TRUE(as_triangles(mesh).empty());
  EXPECT_TRUE(as_triangles(Mesh{}).empty());
}

}  // namespace
}  // namespace ft
