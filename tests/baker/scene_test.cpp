// A shot of several bodies: who meets whom, what stands still, and that what cannot meet is solved as if it were alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "baker/plan/plan.h"
#include "baker/systems/cloth/cloth_group.h"
#include "baker/systems/cloth/meeting.h"
#include "io/shot/mesh_file.h"
#include "tests/support/assets.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr const char* k_ground = "[primary.floor]\nshape = \"ground\"\n";

/// Balls that stand still, each with a sheet above it, and what else is said.
class BallScene {
 public:
  BallScene() { EXPECT_TRUE(write_obj(folder_ / "sheet.obj", make_sheet(0.5, 14, 0.6))); }

  void add_ball(const std::string& name, double x) {
    text_ += "[primary." + name + "]\nshape = \"sphere\"\nradius = 0.15\nrelease = 9999\nposition = [" +
             std::to_string(x) + ", 0.3, 0]\n";
  }
  void add_sheet(const std::string& name, const std::string& on, double x, const std::string& more = "") {
    text_ += "[cloth." + name + "]\nmesh = \"sheet.obj\"\non = \"" + on + "\"\noffset = [" + std::to_string(x) +
             ", 0, 0]\n" + more + "\n";
  }
  void add(const std::string& lines) { text_ += lines; }

  Result<BakePlan> plan(int last_frame = 24) const {
    std::ofstream(folder_ / "shot.toml") << "[shot]\nframes = \"1-" << last_frame << "\"\nfps = 24\npreroll = 0\n"
                                         << text_;
    ShotFaults faults;
    auto inputs = read_inputs(folder_ / "shot.toml", {}, {}, faults);
    if (!inputs) return inputs.error();
    const Importer none = [](const ImportRequest&) -> Result<ImportedPrimary> { return input_error("no files here"); };
    return make_plan(std::move(*inputs), none, {});
  }

 private:
  test::ScratchFolder folder_;
  std::string text_;
};

/// The cloths of a plan's group.
ClothGroup& cloths(const Result<BakePlan>& plan, std::size_t group) {
  return dynamic_cast<ClothGroup&>(*plan->groups.at(group));
}

/// All frames; the last report, with the sums of what must never be.
FrameReport bake_of(ClothGroup& group, int last_frame, std::vector<Vec3>& x) {
  auto solver = make_cloth_solver(std::move(group.setup));
  EXPECT_TRUE(solver) << solver.error().text();
  State state = (*solver)->initial_state();
  FrameReport last;
  int crossings = 0;
  while (state.frame < last_frame) {
    last = (*solver)->advance_frame(state);
    crossings += last.crossings_body + last.crossings_self;
  }
  last.crossings_body = crossings;
  x.resize(at((*solver)->system_mesh(0).vertex_count()));
  (*solver)->system_positions(state, 0, x);
  return last;
}

/// Friction that is not solved for to the end lets cloth creep on for ever. How a sheet falls is chaotic, hence
/// several.
TEST(Scene, Cloth_that_slides_off_a_ball_comes_to_rest_on_the_ground) {
  for (const double x_of_ball : {0.29, 0.3, 0.31}) {
    BallScene scene;
    scene.add_ball("ball", x_of_ball);
    scene.add_sheet("sheet", "ball", 0);
    scene.add(k_ground);
    auto plan = scene.plan(240);
    ASSERT_TRUE(plan) << plan.error().text();
    ASSERT_EQ(plan->groups.size(), 1u);
    EXPECT_EQ(cloths(plan, 0).bodies, (std::vector<std::size_t>{0, 1}));
    const double mass = 0.25 * cloths(plan, 0).setup.garments[0].fabric.mass_per_area;
    std::vector<Vec3> x;
    const FrameReport end = bake_of(cloths(plan, 0), 240, x);
    EXPECT_EQ(end.crossings_body, 0);
    const double lowest =
        (*std::min_element(x.begin(), x.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); })).y();
    EXPECT_GT(lowest, 0);
    EXPECT_LT(lowest, 3.1e-3) << "contact begins at 3 mm";
    EXPECT_LT(end.kinetic_energy / mass, 1e-5)
        << "J/kg, after 10 s: what hangs down from the ball still swings a little";
  }
}

TEST(Scene, What_is_near_is_solved_together_and_what_is_far_apart_alone) {
  for (const double distance : {0.6, 10.0}) {
    BallScene scene;
    scene.add_ball("a", 0);
    scene.add_sheet("sheet_a", "a", 0);
    scene.add_ball("b", distance);
    scene.add_sheet("sheet_b", "b", distance);
    scene.add(k_ground);
    auto plan = scene.plan();
    ASSERT_TRUE(plan) << plan.error().text();
    if (distance < 1) {
      ASSERT_EQ(plan->groups.size(), 1u);
      EXPECT_EQ(cloths(plan, 0).bodies, (std::vector<std::size_t>{0, 1, 2}));
      ASSERT_EQ(cloths(plan, 0).outputs.size(), 2u);
      EXPECT_EQ(cloths(plan, 0).outputs[1].primary, 1u);
      continue;
    }
    ASSERT_EQ(plan->groups.size(), 2u);
    EXPECT_EQ(cloths(plan, 0).bodies, (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(cloths(plan, 1).bodies, (std::vector<std::size_t>{1, 2}));
    // And gives the bytes that it gives alone.
    BallScene alone;
    alone.add_ball("b", distance);
    alone.add_sheet("sheet_b", "b", distance);
    alone.add(k_ground);
    auto alone_plan = alone.plan();
    ASSERT_TRUE(alone_plan) << alone_plan.error().text();
    std::vector<Vec3> x, y;
    bake_of(cloths(plan, 1), 24, x);
    bake_of(cloths(alone_plan, 0), 24, y);
    EXPECT_EQ(x, y);
  }
}

/// A flat sheet of half a metre, at rest on two boxes side by side: the mean forces of the last second, on each.
struct OnTwoBoxes {
  double weight = 0;            ///< N
  std::vector<Wrench> mean;     ///< on "left", whose top is all x < -0.01, and on "right", all x > 0.01
  std::vector<double> touched;  ///< seconds
};

OnTwoBoxes sheet_on_boxes(double x) {
  BallScene scene;
  for (const char* box : {"left", "right"})
    scene.add(std::string("[primary.") + box +
              "]\nshape = \"box\"\nsize = [1, 0.3, 0.8]\nrelease = 9999\nposition = [" +
              (box == std::string("left") ? "-" : "") + "0.51, 0.445, 0]\n");
  scene.add_sheet("sheet", "left", x, "self_collision = false");
  auto plan = scene.plan(144);
  EXPECT_TRUE(plan) << plan.error().text();
  OnTwoBoxes out;
  out.weight = 0.25 * cloths(plan, 0).setup.garments[0].fabric.mass_per_area * k_gravity;
  auto solver = make_cloth_solver(std::move(cloths(plan, 0).setup));
  EXPECT_TRUE(solver) << solver.error().text();
  State state = (*solver)->initial_state();
  out.mean.resize(2);
  out.touched.resize(2);
  while (state.frame < 144) {
    const FrameReport report = (*solver)->advance_frame(state);
    EXPECT_EQ(report.forces.size(), 2u);
    for (std::size_t b = 0; b < 2; ++b) {
      EXPECT_EQ(report.forces[b].system, "sheet");
      EXPECT_EQ(report.forces[b].primary, b == 0 ? "left" : "right");
      out.touched[b] += report.forces[b].contact_share / 24;
      if (report.frame > 120) out.mean[b] += (1.0 / 24) * report.forces[b].mean;
    }
  }
  return out;
}

TEST(Scene, A_sheet_on_two_boxes_presses_on_both_with_its_weight_in_all) {
  for (const double x : {0.0, 0.12}) {
    const OnTwoBoxes sheet = sheet_on_boxes(x);
    EXPECT_NEAR(sheet.mean[0].force.y() + sheet.mean[1].force.y(), -sheet.weight, 0.01 * sheet.weight) << x;
    // What lies on the right box, and half of what bridges the gap: a flat sheet that bends little.
    const double share = 0.5 + x / 0.5;
    EXPECT_NEAR(sheet.mean[1].force.y(), -share * sheet.weight, 0.05 * sheet.weight) << x;
    // Its middle is where what lies there has its own, seen from the box's.
    const double arm = sheet.mean[1].torque.z() / sheet.mean[1].force.y(), middle = 0.5 * (x + 0.25) - 0.51;
    EXPECT_NEAR(arm, middle, 0.02) << x;
  }
}

TEST(Scene, A_sheet_that_lies_on_one_box_does_nothing_to_the_other) {
  const OnTwoBoxes sheet = sheet_on_boxes(-0.4);
  EXPECT_NEAR(sheet.mean[0].force.y(), -sheet.weight, 0.01 * sheet.weight);
  EXPECT_EQ(sheet.mean[1].force, Vec3(Vec3::Zero()));
  EXPECT_EQ(sheet.mean[1].torque, Vec3(Vec3::Zero()));
  EXPECT_EQ(sheet.touched[1], 0);
}

TEST(Scene, Cloths_of_two_wearers_meet_each_other) {
  BallScene scene;
  scene.add_ball("a", 0);
  scene.add_sheet("sheet_a", "a", 0);
  scene.add_ball("b", 0.3);
  scene.add_sheet("sheet_b", "b", 0.25, "unit_scale = 0.9");
  scene.add(k_ground);
  auto plan = scene.plan(40);
  ASSERT_TRUE(plan) << plan.error().text();
  ASSERT_EQ(plan->groups.size(), 1u);
  std::vector<Vec3> x;
  EXPECT_EQ(bake_of(cloths(plan, 0), 40, x).crossings_body, 0);
}

TEST(Scene, A_cloth_meets_what_its_key_says) {
  BallScene scene;
  scene.add_ball("ball", 0.3);
  scene.add(k_ground);
  scene.add_sheet("none", "ball", 0, "meets = []");
  auto alone = scene.plan();
  ASSERT_TRUE(alone) << alone.error().text();
  EXPECT_EQ(cloths(alone, 0).bodies, std::vector<std::size_t>{0});
  scene.add_sheet("all", "ball", 0.8);
  auto both = scene.plan();
  ASSERT_TRUE(both) << both.error().text();
  const ClothGroup& group = cloths(both, 0);
  ASSERT_TRUE(group.joint);
  EXPECT_EQ(group.setup.garments[0].ignores, (std::vector<int>{1})) << "the ground is part 1";
  EXPECT_TRUE(group.setup.garments[1].ignores.empty());
  scene.add_sheet("wrong", "ball", 0, "meets = [\"flor\"]");
  const auto wrong = scene.plan();
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().text().find("did you mean \"floor\""), std::string::npos) << wrong.error().text();
}

TEST(Scene, A_box_on_the_ground_stays_whole) {
  BallScene scene;
  scene.add("[primary.chair]\nshape = \"box\"\nsize = [0.4, 0.3, 0.4]\nposition = [0, 0.15, 0]\nrelease = 9999\n");
  scene.add_sheet("sheet", "chair", 0);
  scene.add(k_ground);
  auto plan = scene.plan();
  ASSERT_TRUE(plan) << plan.error().text();
  const FeasiblePoses& poses = *cloths(plan, 0).setup.poses;
  std::vector<Vec3> drawn(at(poses.body().surface().vertex_count())), x(at(poses.collider().vertex_count()));
  std::vector<char> absent(x.size());
  poses.body().sample(0, drawn);
  EXPECT_EQ(poses.evaluate(0, drawn, x, absent).moved_vertices, 0);
  EXPECT_EQ(std::count(absent.begin(), absent.end(), char{1}), 0) << "although its bottom looks at the ground";
}

TEST(Scene, Joint_bodies_keep_their_parts_apart_and_what_stands_still_as_it_is) {
  BallScene scene;
  scene.add_ball("ball", 0);
  scene.add(k_ground);
  scene.add_sheet("sheet", "ball", 0);
  auto plan = scene.plan();
  ASSERT_TRUE(plan) << plan.error().text();
  const ClothGroup& group = cloths(plan, 0);
  const Surface& surface = group.joint->surface();
  ASSERT_EQ(surface.parts.size(), 2u);
  EXPECT_EQ(surface.parts[1].name, "floor");
  EXPECT_TRUE(surface.parts[1].fixed);
  EXPECT_EQ(surface.vertex_count(), plan->primaries[0].trajectory->surface().vertex_count() +
                                        plan->primaries[1].trajectory->surface().vertex_count());
  const std::vector<ColliderSlice> slices = group.slices(*plan, {});
  ASSERT_EQ(slices.size(), 2u);
  EXPECT_EQ(slices[1].name, "floor");
  EXPECT_EQ(slices[1].triangles.size(), plan->primaries[1].trajectory->surface().triangles.size())
      << "a ground is not refined";
  std::size_t all = 0;
  for (const ColliderSlice& slice : slices) {
    all += slice.vertices.size();
    for (const Triangle& t : slice.triangles)
      for (const int v : t) EXPECT_LT(at(v), slice.vertices.size());
  }
  EXPECT_EQ(all, at(group.setup.poses->collider().vertex_count()));
  // Runs of the whole collider, told of its slices.
  const int ground = slices[1].vertices[2];
  const std::vector<AbsentRuns> told = sliced({"sheet", {{0, 2}, {ground, 1}}}, slices);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].runs, (std::vector<std::array<int, 2>>{{0, 2}}));
  EXPECT_EQ(told[1].collider, "floor");
  EXPECT_EQ(told[1].runs, (std::vector<std::array<int, 2>>{{2, 1}}));
}

}  // namespace
}  // namespace ft
