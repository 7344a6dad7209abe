#include "baker/core/output_shape.h"

#include <gtest/gtest.h>

#include <limits>

#include "baker/core/output_frame.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

TEST(OutputShape, Keys_come_back_and_others_are_none) {
  for (const OutputShape shape : {OutputShape::k_mesh, OutputShape::k_curves, OutputShape::k_points,
                                  OutputShape::k_instances, OutputShape::k_grid})
    EXPECT_EQ(find_shape(shape_key(shape)), shape);
  EXPECT_FALSE(find_shape("").has_value());
  EXPECT_FALSE(find_shape("a mesh").has_value());
}

TEST(OutputShape, Prototypes_and_their_meshes_go_together) {
  SystemShape shape;
  EXPECT_EQ(fault_of_prototypes(shape), "");
  shape.instances = {{7, 8}, {0, 1}, {"oak", "maple"}};
  EXPECT_EQ(fault_of_prototypes(shape), "2 prototypes with 0 meshes");
  shape.prototypes.resize(2);
  EXPECT_EQ(fault_of_prototypes(shape), "");
  shape.instances.prototypes[1] = 2;
  EXPECT_EQ(fault_of_prototypes(shape), "there is no prototype 2");
}

TEST(OutputShape, Joined_meshes_keep_their_faces_in_groups_of_their_own) {
  Mesh a = make_sheet(1, 2, 0), b = make_sheet(2, 1, 1);
  a.name = std::string("a"), b.name = std::string("b");
  const std::vector<Mesh> both = {a, b};
  const Mesh joined = joined_meshes("both", both);
  EXPECT_EQ(joined.vertex_count(), a.vertex_count() + b.vertex_count());
  EXPECT_EQ(joined.face_count(), a.face_count() + b.face_count());
  ASSERT_EQ(joined.groups.size(), 2u);
  EXPECT_EQ(joined.groups[1].name, "b");
  EXPECT_EQ(joined.groups[1].vertices.front(), a.vertex_count());
  for (std::size_t k = 0; k < b.face_vertices.size(); ++k)
    EXPECT_EQ(joined.face_vertices[a.face_vertices.size() + k], b.face_vertices[k] + a.vertex_count());
}

TEST(OutputFrame, One_number_that_is_not_finite_is_found_wherever_it_is) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  FrameData good;
  good.positions = good.velocities = good.angular_velocities = good.scales = {Vec3f::Zero(), Vec3f::Ones()};
  good.orientations = {Eigen::Quaternionf::Identity()};
  good.widths = {1};
  EXPECT_TRUE(all_finite(good));
  for (std::vector<Vec3f> FrameData::*values :
       {&FrameData::positions, &FrameData::velocities, &FrameData::angular_velocities, &FrameData::scales}) {
    FrameData bad = good;
    (bad.*values)[1].y() = nan;
    EXPECT_FALSE(all_finite(bad));
  }
  FrameData bad = good;
  bad.orientations[0].w() = nan;
  EXPECT_FALSE(all_finite(bad));
  bad = good;
  bad.widths[0] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(all_finite(bad));
}

}  // namespace
}  // namespace ft
