#include "baker/core/triangle_corners.h"

#include <gtest/gtest.h>

namespace ft {
namespace {

TEST(TriangleCorners, Quads_are_split_by_the_shorter_diagonal_and_equal_ones_from_the_first_corner) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1.5, 1.5, 0}};
  mesh.face_sizes = {4, 4, 3};
  mesh.face_vertices = {0, 1, 2, 3, 0, 1, 4, 3, 2, 1, 4};
  EXPECT_EQ(triangle_corners(mesh), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {4, 5, 7}, {5, 6, 7}, {8, 9, 10}}));
  EXPECT_EQ(triangulate(mesh), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 4, 3}, {2, 1, 4}}));
}

TEST(TriangleCorners, More_corners_make_a_fan_from_the_first) {
  Mesh mesh;
  mesh.positions.assign(6, Vec3::Zero());
  mesh.face_sizes = {5};
  mesh.face_vertices = {5, 1, 2, 3, 4};
  EXPECT_EQ(triangulate(mesh), (std::vector<Triangle>{{5, 1, 2}, {5, 2, 3}, {5, 3, 4}}));
}

}  // namespace
}  // namespace ft
