// [leaves.NAME] from the shot file to the frames of its caches.
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "baker/core/output_frame.h"
#include "baker/plan/plan.h"
#include "baker/systems/leaves/leaves_group.h"
#include "io/shot/shot_keys.h"
#include "solvers/wind/registry.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

class LeavesShot : public testing::Test {
 protected:
  /// Of two primaries, a ground and a ball that rolls past 0.2 m above it, with a field that the lines say.
  Result<BakePlan> plan(const std::string& lines, int last_frame = 24, std::optional<FrameRange> part = {}) const {
    std::ofstream(folder_ / "shot.toml") << "[shot]\nframes = \"1-" << last_frame
                                         << "\"\nfps = 24\npreroll = 0\n[primary.floor]\nshape = \"ground\"\n"
                                            "[primary.ball]\nshape = \"sphere\"\nradius = 0.15\nvelocity = [6, 0, 0]\n"
                                            "position = [-2, 0.2, 0]\nrelease = 9999\n"
                                         << lines;
    ShotFaults faults;
    auto inputs = read_inputs(folder_ / "shot.toml", {}, part, faults);
    if (!inputs) return inputs.error();
    const Importer none = [](const ImportRequest&) -> Result<ImportedPrimary> { return input_error("no files here"); };
    return make_plan(std::move(*inputs), none, {});
  }
  std::string refusal(const std::string& lines) const {
    const auto made = plan(lines);
    return made ? "it was planned" : made.error().text();
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  test::ScratchFolder folder_;
};

/// All frames; the last one, and what the reports add up to.
struct Baked {
  FrameData last;
  int crossings = 0;
  double lifted = 0, awake_at_end = 0;
};
Baked bake(BakePlan& plan, int last_frame) {
  auto solver = plan.groups.at(0)->make_solver();
  EXPECT_TRUE(solver) << solver.error().text();
  State state = (*solver)->initial_state();
  Baked out;
  while (state.frame < last_frame) {
    const FrameReport report = (*solver)->advance_frame(state);
    out.crossings += report.crossings_body;
    out.lifted += report.own.at("leaves_lifted");
    out.awake_at_end = report.own.at("leaves_awake");
  }
  (*solver)->system_frame(state, 0, out.last);
  return out;
}

constexpr const char* k_region = "[leaves.oak]\non = \"floor\"\ncount = 300\nsize = [2, 0, 1]\nlift = 0.4\n";

TEST_F(LeavesShot, They_lie_over_their_region_each_with_a_place_of_its_own) {
  auto made = plan(k_region);
  ASSERT_TRUE(made) << made.error().text();
  ASSERT_EQ(made->groups.size(), 1u);
  const auto& group = dynamic_cast<LeavesGroup&>(*made->groups[0]);
  ASSERT_EQ(group.setup.leaves.size(), 300u);
  std::set<double> places;
  for (const Leaf& leaf : group.setup.leaves) {
    EXPECT_LE(std::abs(leaf.position.x()), 1);
    EXPECT_LE(std::abs(leaf.position.z()), 0.5);
    EXPECT_TRUE(leaf.position.y() > 0 && leaf.position.y() < 0.01) << leaf.position.y();
    EXPECT_TRUE(leaf.asleep);
    places.insert(leaf.position.x());
  }
  EXPECT_EQ(places.size(), 300u);
  EXPECT_EQ(group.meets, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(group.setup.grounds.size(), 1u);
  EXPECT_EQ(group.setup.bodies.size(), 1u);
  EXPECT_NE(group.lines(*made)[0].find("300, of which 300 lie"), std::string::npos) << group.lines(*made)[0];
}

TEST_F(LeavesShot, In_still_air_they_stay_where_they_are_but_for_what_comes_by) {
  auto made = plan(std::string(k_region) + "meets = []\n");
  ASSERT_TRUE(made) << made.error().text();
  std::vector<Vec3f> start;
  for (const Leaf& leaf : dynamic_cast<LeavesGroup&>(*made->groups[0]).setup.leaves)
    start.push_back(leaf.position.cast<float>());
  const Baked baked = bake(*made, 24);
  EXPECT_EQ(baked.crossings, 0);
  EXPECT_EQ(baked.lifted, 0);
  EXPECT_EQ(baked.last.positions, start);
}

TEST_F(LeavesShot, The_wake_of_a_body_lifts_them_and_they_settle_again) {
  auto made = plan(std::string(k_region) + "[wind.wake]\nkind = \"wake\"\nof = \"ball\"\ngain = 3\n", 144);
  ASSERT_TRUE(made) << made.error().text();
  const Baked baked = bake(*made, 144);
  EXPECT_EQ(baked.crossings, 0);
  EXPECT_GT(baked.lifted, 5);
  EXPECT_EQ(baked.awake_at_end, 0);
}

TEST_F(LeavesShot, What_hangs_in_the_air_falls_and_is_not_asleep) {
  auto made = plan("[leaves.oak]\non = \"floor\"\ncount = 20\nsize = [1, 2, 1]\n", 12);
  ASSERT_TRUE(made) << made.error().text();
  double before = 0, after = 0;
  for (const Leaf& leaf : dynamic_cast<LeavesGroup&>(*made->groups[0]).setup.leaves) before += leaf.position.y() / 20;
  const Baked baked = bake(*made, 12);
  for (const Vec3f& p : baked.last.positions) after += p.y() / 20;
  EXPECT_LT(after, before - 0.1);
}

TEST_F(LeavesShot, Places_come_from_a_mesh_or_from_a_file) {
  write("roof.obj", "v 0 1 0\nv 1 1.2 0\nv 1 1.2 1\nv 0 1 1\nf 1 4 3 2\n");
  auto on_mesh = plan("[leaves.oak]\non = \"floor\"\ncount = 50\nover = \"roof.obj\"\nposition = [0, 0, 3]\n");
  ASSERT_TRUE(on_mesh) << on_mesh.error().text();
  for (const Leaf& leaf : dynamic_cast<LeavesGroup&>(*on_mesh->groups[0]).setup.leaves) {
    EXPECT_NEAR(leaf.position.y(), 1 + 0.2 * leaf.position.x(), 0.012);
    EXPECT_GE(leaf.position.z(), 2.98);
  }
  write("places.csv", "x,y,z,heading,scale\n1,0,2,90,1.5\n-1, 0, 0\n");
  auto placed = plan("[leaves.oak]\non = \"floor\"\nplaced = \"places.csv\"\n");
  ASSERT_TRUE(placed) << placed.error().text();
  const auto& leaves = dynamic_cast<LeavesGroup&>(*placed->groups[0]).setup.leaves;
  ASSERT_EQ(leaves.size(), 2u);
  EXPECT_EQ(leaves[0].scale, 1.5);
  EXPECT_LT((leaves[0].orientation * Vec3::UnitX() - Vec3(0, 0, -1)).norm(), 1e-9) << "turned by 90 degrees about y";
  EXPECT_NEAR(leaves[1].position.x(), -1, 1e-9);
}

TEST_F(LeavesShot, The_fold_of_a_leaf_is_that_of_its_mesh) {
  write("leaf.obj", "v -0.04 0 0\nv 0.04 0 0\nv 0 0.01 0.02\nv 0 0.01 -0.02\nf 1 3 2\nf 1 2 4\n");
  auto made = plan("[leaves.oak]\non = \"floor\"\nsize = [1, 0, 1]\nmesh = \"leaf.obj\"\n");
  ASSERT_TRUE(made) << made.error().text();
  EXPECT_NEAR(dynamic_cast<LeavesGroup&>(*made->groups[0]).setup.prototypes[0].fold, std::atan(0.5), 1e-12);
}

TEST_F(LeavesShot, Those_that_start_near_the_camera_bend_and_all_others_are_instances) {
  auto made = plan(std::string(k_region) + "camera = [1, 0, 0]\nnear = 0.5\n");
  ASSERT_TRUE(made) << made.error().text();
  ASSERT_EQ(made->groups.size(), 2u);
  const LeavesSetup &far = dynamic_cast<LeavesGroup&>(*made->groups[0]).setup,
                    &near = dynamic_cast<LeavesGroup&>(*made->groups[1]).setup;
  EXPECT_EQ(far.leaves.size() + near.leaves.size(), 300u);
  EXPECT_GT(near.leaves.size(), 10u);
  EXPECT_EQ(near.name, "oak_near");
  EXPECT_EQ(far.bending, 0);
  EXPECT_GT(near.bending, 0);
  for (const Leaf& leaf : far.leaves) EXPECT_GT((leaf.position - Vec3(1, 0, 0)).norm(), 0.5);
  for (const Leaf& leaf : near.leaves) EXPECT_LE((leaf.position - Vec3(1, 0, 0)).norm(), 0.5);
  ASSERT_TRUE(made->groups[1]->outputs.at(0).mesh);
  EXPECT_EQ(made->groups[1]->outputs[0].mesh->vertex_count(),
            static_cast<int>(near.leaves.size() * near.prototypes[0].positions.size()));

  const auto none = plan(std::string(k_region) + "camera = [100, 0, 0]\nnear = 0.5\n");
  ASSERT_TRUE(none) << none.error().text();
  EXPECT_EQ(none->groups.size(), 1u);
  EXPECT_TRUE(std::ranges::any_of(none->notes, [](const std::string& n) { return n.find("none bends") != n.npos; }));
}

TEST_F(LeavesShot, What_makes_no_sense_is_refused_with_its_place) {
  write("wall.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  write("bad.csv", "1 2 3\nfour 5 6\n");
  for (const auto& [lines, words] : {
           std::pair("size = [2, 0, 0]\n", "size has no area"),
           {"count = 3\n", "over, placed or size is missing"},
           {"size = [1, 0, 1]\nover = \"wall.obj\"\n", "more than one of over, placed and size"},
           {"over = \"wall.obj\"\n", "no face of it looks up"},
           {"placed = \"bad.csv\"\n", "bad.csv:2"},
           {"placed = \"bad.csv\"\ncount = 4\n", "count does not go with placed"},
           {"size = [1, 0, 1]\nnear = 2\n", "near is measured from camera, which is missing"},
           {"size = [1, 0, 1]\nbending = 1e-5\n", "bending is for near leaves, and near is missing"},
           {"size = [1, 0, 1]\nmesh = \"wall.obj\"\nlength = 0.1\n", "length does not go with mesh"},
       }) {
    const std::string said = refusal(std::string("[leaves.oak]\non = \"floor\"\n") + lines);
    EXPECT_NE(said.find(words), std::string::npos) << lines << said;
    EXPECT_NE(said.find("oak"), std::string::npos) << said;
  }
}

TEST_F(LeavesShot, What_else_is_called_as_the_near_leaves_is_refused) {
  const std::string near = std::string(k_region) + "camera = [1, 0, 0]\nnear = 0.5\n";
  const std::string twice = refusal(near + "[leaves.oak_near]\non = \"floor\"\nsize = [1, 0, 1]\n");
  EXPECT_NE(twice.find("makes \"oak_near\", too"), std::string::npos) << twice;
  const std::string body = refusal(near + "[primary.oak_near]\nshape = \"sphere\"\nradius = 0.1\n");
  EXPECT_NE(body.find("a primary has the same name as its \"oak_near\""), std::string::npos) << body;
}

TEST_F(LeavesShot, Winds_that_make_no_sense_are_refused_with_their_place) {
  for (const auto& [lines, words] : {
           std::pair("kind = \"uniform\"\nvelocity = [0, 0, 0]\n", "a direction"),
           {"kind = \"uniform\"\nvelocity = [900, 0, 0]\n", "outside [-100, 100]"},
           {"kind = \"uniform\"\n", "velocity is missing"},
           {"kind = \"breeze\"\n", "uniform"},
           {"kind = \"wake\"\n", "of is missing"},
           {"kind = \"wake\"\nof = \"bal\"\n", "ball"},
           {"kind = \"wake\"\nof = \"ball\"\nparts = [\"leg*\"]\n", "leg*"},
           {"kind = \"vortex\"\ncirculation = 2\naxis = [0, 0, 0]\n", "its axis is 0"},
           {"kind = \"source\"\nflow = 2\nintensity = 3\n", "intensity"},
           {"kind = \"uniform\"\nvelocity = [1, 0, 0]\nfrom = 20\nuntil = 10\n", "it would never blow"},
           {"kind = \"grid\"\nfile = \"none.vdb\"\n", "none.vdb"},
       }) {
    const std::string said = refusal(std::string(k_region) + "[wind.odd]\n" + lines);
    EXPECT_NE(said.find(words), std::string::npos) << lines << said;
  }
}

TEST(Winds, The_shot_file_and_the_registry_know_the_same_kinds) {
  std::vector<std::string> fields;
  for (const WindFieldKind& kind : wind_field_kinds()) fields.emplace_back(kind.name);
  ASSERT_EQ(wind_field_keys()[0].name, "kind");
  EXPECT_EQ(split_words(wind_field_keys()[0].choices), fields);
}

TEST_F(LeavesShot, A_part_of_a_shot_has_the_gusts_of_the_whole) {
  const std::string lines = std::string(k_region) +
                            "[wind.gusty]\nkind = \"uniform\"\nvelocity = [5, 0, 0]\n"
                            "gusts = 0.4\n[wind.eddies]\nkind = \"turbulence\"\nintensity = 1\n";
  auto whole = plan(lines), part = plan(lines, 24, FrameRange{13, 24});
  ASSERT_TRUE(whole) << whole.error().text();
  ASSERT_TRUE(part) << part.error().text();
  const Vec3 place(0.2, 1, -0.3);
  EXPECT_LT((part->wind->at_time(0.25)->velocity(place) - whole->wind->at_time(0.75)->velocity(place)).norm(), 1e-12);
}

TEST_F(LeavesShot, Of_winds_the_plan_says_how_fast_they_are_at_most_and_when_they_blow) {
  auto made = plan(std::string(k_region) +
                   "[wind]\nvelocity = [1, 0, 0]\n[wind.later]\nkind = \"vortex\"\n"
                   "circulation = 3\nradius = 0.5\nfrom = 12\nfade = 6\n");
  ASSERT_TRUE(made) << made.error().text();
  EXPECT_EQ(made->wind->fields().size(), 2u);
  const Vec3 place(0, 1, 2);
  EXPECT_LT((made->wind->at_time(0)->velocity(place) - Vec3(1, 0, 0)).norm(), 1e-12);
  EXPECT_GT(made->wind->at_time(0.9)->velocity(place).x(), 1.1);
}

}  // namespace
}  // namespace ft
