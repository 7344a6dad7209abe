// Rigid props: what a shape weighs, and what is read off an imported surface that moves as one.
#include "baker/plan/prop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/shapes.h"

namespace ft {
namespace {

/// A box that tumbles along a parabola, and bends by so much at the end of a second.
class TumblingBox final : public Trajectory {
 public:
  explicit TumblingBox(double bends) : bends_(bends) {
    const TriangleSurface box = box_surface({0.2, 0.3, 0.5});
    x_ = box.positions;
    for (Vec3& p : x_) p += Vec3(0.7, 0, 0);  // its middle is not its origin
    surface_.triangles = box.triangles;
    surface_.part_of_vertex.assign(x_.size(), 0);
    surface_.parts = {{"box", -1, 0.03}};
  }
  static Vec3 centre(double t) { return Vec3(0.7, 0, 0) + t * Vec3(2, 3, -1) + 0.5 * t * t * Vec3(0, -k_gravity, 0); }
  static Quat turn(double t) { return Quat(Eigen::AngleAxisd(2.0 * t, Vec3(0, 1, 0))); }
  const Surface& surface() const override { return surface_; }
  void bind_pose(std::span<Vec3> out) const override { std::copy(x_.begin(), x_.end(), out.begin()); }
  void sample(double time, std::span<Vec3> out) const override {
    for (std::size_t i = 0; i < x_.size(); ++i) out[i] = centre(time) + turn(time) * (x_[i] - Vec3(0.7, 0, 0));
    out[0].x() += bends_ * time;
  }
  Eigen::Isometry3d bind_to_start() const override { return Eigen::Isometry3d::Identity(); }
  double preroll() const override { return 0; }

 private:
  double bends_;
  std::vector<Vec3> x_;
  Surface surface_;
};

Shot a_second() {
  Shot shot;
  shot.file = "shot.toml";
  shot.first_frame = 1;
  shot.last_frame = 25;
  shot.fps = 24;
  return shot;
}

TEST(Prop, An_imported_box_is_followed_by_pose_velocity_and_spin) {
  PrimarySpec spec;
  spec.name = "box";
  auto prop = prop_of_trajectory(spec, a_second(), std::make_shared<TumblingBox>(0), 3);
  ASSERT_TRUE(prop) << prop.error().text();
  EXPECT_NEAR(prop->mass.inertia(0, 0), 3.0 / 12 * (0.09 + 0.25), 1e-12);
  for (const double t : {0.0, 0.02, 0.25, 0.5, 1.0}) {
    const RigidMotion m = prop->track(t);
    EXPECT_LT((m.pose.position - TumblingBox::centre(t)).norm(), 1e-12) << t;
    EXPECT_LT((m.velocity - Vec3(2, 3 - k_gravity * t, -1)).norm(), 1e-9) << t;
    EXPECT_LT((m.spin - Vec3(0, 2, 0)).norm(), 1e-9) << t;
  }
  EXPECT_EQ(prop->track(-0.5).velocity, Vec3::Zero());
}

TEST(Prop, Once_released_it_flies_on_from_where_its_clip_had_it) {
  PrimarySpec spec;
  spec.name = "box";
  spec.release = Release::k_frame;
  spec.release_frame = 13;  // half a second
  auto prop = prop_of_trajectory(spec, a_second(), std::make_shared<TumblingBox>(0), 3);
  ASSERT_TRUE(prop) << prop.error().text();
  EXPECT_LT((prop->track(0.9).pose.position - TumblingBox::centre(0.9)).norm(), 1e-9);  // it flew before, too
  EXPECT_LT((prop->track(0.9).pose.rotation.toRotationMatrix() - TumblingBox::turn(0.9).toRotationMatrix()).norm(),
            1e-6);
}

TEST(Prop, What_bends_is_no_prop) {
  PrimarySpec spec;
  spec.name = "box";
  const auto prop = prop_of_trajectory(spec, a_second(), std::make_shared<TumblingBox>(0.01), 3);
  ASSERT_FALSE(prop);
  EXPECT_NE(prop.error().text().find("no rigid prop"), std::string::npos) << prop.error().text();
}

TEST(Prop, Shapes_weigh_what_formulas_say) {
  PrimarySpec spec;
  spec.name = "ball";
  spec.shape = "sphere";
  spec.radius = 0.121;
  spec.mass = 0.68;
  spec.hollow = true;
  EXPECT_NEAR(prop_of_shape(spec, a_second()).mass.inertia(0, 0), 0.00664, 1e-5);
  spec.hollow = false;
  EXPECT_NEAR(prop_of_shape(spec, a_second()).mass.inertia(2, 2), 0.4 * 0.68 * 0.121 * 0.121, 1e-15);
  spec.shape = "capsule";
  spec.radius = 0.1;
  spec.length = 0.4;
  spec.mass = 2;
  // A cylinder and two half spheres, by volume.
  const double cylinder = 0.4, halves = 4.0 / 3 * 0.1, all = cylinder + halves;  // in units of pi r^2
  const double mc = 2 * cylinder / all, ms = 2 * halves / all, r = 0.1, l = 0.4;
  const double across = mc * (r * r / 4 + l * l / 12) + ms * (0.4 * r * r + l * l / 4 + 3.0 / 8 * l * r);
  EXPECT_NEAR(prop_of_shape(spec, a_second()).mass.inertia(0, 0) / across, 1, 0.01);
}

}  // namespace
}  // namespace ft
