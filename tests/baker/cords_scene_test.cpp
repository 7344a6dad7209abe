// Cords in a shot of several primaries: whom they meet, who says so, and how a bake of them is judged.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "baker/judge/judge_caches.h"
#include "baker/plan/plan_text.h"
#include "baker/record/manifest.h"
#include "baker/run/bake.h"
#include "baker/systems/cords/cords_group.h"
#include "tests/baker/fake_bake.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

/// A rope above a box above a ground; it is on the box.
class RopeScene {
 public:
  std::string cords = "on = \"box\"\n";
  std::string more;

  std::filesystem::path shot() const {
    std::ofstream(folder_ / "shot.toml") << R"([shot]
frames = "1-24"
fps = 24
preroll = 0
[primary.box]
shape = "box"
size = [0.2, 0.1, 0.3]
position = [0, 0.3, 0]
release = 9999
[primary.floor]
shape = "ground"
[cords.rope]
shape = "rope"
position = [-0.4, 0.37, 0.01]
to = [0.4, 0.38, 0.03]
held = "none"
points = 24
mass = 0.1
radius = 0.005
)" << cords << more;
    return folder_ / "shot.toml";
  }
  Result<BakePlan> plan() const {
    ShotFaults faults;
    auto inputs = read_inputs(shot(), {}, {}, faults);
    if (!inputs) return usage_error(faults.messages.empty() ? inputs.error().text() : faults.messages[0]);
    const Importer none = [](const ImportRequest&) -> Result<ImportedPrimary> { return input_error("no files here"); };
    return make_plan(std::move(*inputs), none, {});
  }
  std::filesystem::path out() const { return folder_ / "out"; }

 private:
  test::ScratchFolder folder_;
};

std::vector<std::string> met(const BakePlan& plan) {
  std::vector<std::string> out;
  for (const MetBody& body : dynamic_cast<const CordsGroup&>(*plan.groups.at(0)).setup.bodies) out.push_back(body.name);
  return out;
}

bool says(const std::vector<std::string>& lines, const std::string& what) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(what) != std::string::npos; });
}

TEST(CordsScene, They_meet_every_primary_unless_their_key_says_otherwise) {
  RopeScene scene;
  auto plan = scene.plan();
  ASSERT_TRUE(plan) << plan.error().text();
  const std::vector<std::string> both{"box", "floor"}, own{"box"};
  EXPECT_EQ(met(*plan), both);
  EXPECT_TRUE(says(plan->groups[0]->lines(*plan), "meets \"box\", \"floor\""));
  scene.cords = "on = \"floor\"\nmeets = [\"B*\"]\n";
  plan = scene.plan();
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_EQ(met(*plan), both) << "its own, too";
  scene.cords = "on = \"box\"\nmeets = []\n";
  plan = scene.plan();
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_EQ(met(*plan), own);
  EXPECT_TRUE(says(plan->groups[0]->lines(*plan), "meets \"box\" alone"));
  scene.cords = "on = \"box\"\nmeets = [\"flor\"]\n";
  plan = scene.plan();
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().text().find("floor"), std::string::npos) << plan.error().text();
}

TEST(CordsScene, What_two_way_coupling_leaves_out_is_a_note) {
  RopeScene scene;
  scene.more =
      "[primary.ball]\nshape = \"sphere\"\nradius = 0.1\nmass = 1\nposition = [0, 1, 0]\nvelocity = [0, 0, 0]\n"
      "[cords.string]\nshape = \"rope\"\non = \"ball\"\ncoupling = \"two-way\"\nposition = [-0.3, 0.8, 0]\n"
      "to = [0.3, 0.8, 0]\nheld = \"both\"\nmass = 0.1\n";
  const auto plan = scene.plan();
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_TRUE(says(plan->notes, "cords on \"box\" do not meet \"ball\": where it goes is only known"));
  EXPECT_TRUE(says(plan->notes, "\"ball\" goes where its cords let it (two-way) and does not meet \"box\", \"floor\""));
}

TEST(CordsScene, A_bake_has_its_forces_on_each_primary_and_is_judged_against_all) {
  RopeScene scene;
  BakeOptions options;
  options.shot_file = scene.shot();
  options.folder = scene.out();
  BakeServices services;
  services.make_solver = make_group_solver;
  test::RecordedProgress progress;
  const BakeResult result = bake(options, services, progress);
  ASSERT_EQ(result.exit_code, 0) << (result.faults.empty() ? "" : result.faults[0]);
  const auto manifest = read_manifest(scene.out());
  ASSERT_TRUE(manifest);
  EXPECT_EQ(manifest->systems[0].meets, (std::vector<std::string>{"box", "floor"}));
  const auto& forces = manifest->frames.back().forces;
  ASSERT_EQ(forces.size(), 2u);
  EXPECT_EQ(forces[0].primary, "box");
  EXPECT_LT(forces[0].mean.force.y(), 0);
  EXPECT_EQ(forces[1].primary, "floor");
  const auto judged = judge_caches(scene.out());
  ASSERT_TRUE(judged) << judged.error().text();
  EXPECT_TRUE(judged->notes.empty());
  for (const FrameReport& r : judged->frames) {
    EXPECT_EQ(r.crossings_body, 0) << r.frame;
    EXPECT_EQ(r.deepest_drawn, 0) << r.frame;
  }
  options.overrides = {"cache.collider=false"};
  ASSERT_EQ(bake(options, services, progress).exit_code, 0);
  const auto without = judge_caches(scene.out());
  ASSERT_TRUE(without) << without.error().text();
  EXPECT_TRUE(says(without->notes, "\"floor\" is not cached"));
}

}  // namespace
}  // namespace ft
