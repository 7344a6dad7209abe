// Parts that a shot takes out of the body: by patterns, for all cloths of a primary and for one.
#include <gtest/gtest.h>

#include "tests/baker/fake_bake.h"
#include "tests/support/scripted_body.h"

namespace ft::test {
namespace {

/// The box with its corners in four parts.
std::unique_ptr<Trajectory> box_of_parts(const Trajectory& box, const ImportRequest&) {
  Surface surface = box.surface();
  std::vector<Vec3> points(8);
  box.bind_pose(points);
  surface.parts = {{"spine", -1, 1.0}, {"Hand_L", 0, 0.1}, {"Hand_R", 0, 0.1}, {"thumb_r", 2, 0.01}};
  surface.part_of_vertex = {0, 0, 0, 0, 0, 1, 2, 3};
  return std::make_unique<ScriptedBody>(surface, points, box.preroll(), [](double, std::span<Vec3>) {});
}

/// A dry run with keys, and the parts that each cloth ignores in a bake's setup.
struct Planned {
  BakeResult dry;
  std::vector<std::vector<int>> ignores;
};

Planned planned(const std::vector<std::string>& keys, const std::string& extra = "") {
  FakeScene scene;
  scene.write_shot(2, "", extra);
  BakeOptions options = scene.options();
  options.overrides = keys;
  BakeServices services = scene.services({.move = box_of_parts});
  Planned out;
  services.make_solver = [&out, make = services.make_solver](SystemGroup& group) {
    for (const ClothGarment& garment : dynamic_cast<ClothGroup&>(group).setup.garments)
      out.ignores.push_back(garment.ignores);
    return make(group);
  };
  Progress silent;
  bake(options, services, silent);
  options.dry_run = true;
  out.dry = bake(options, services, silent);
  return out;
}

TEST(IgnoredParts, Patterns_of_the_primary_and_of_a_cloth_add_up) {
  const std::string vest = "[cloth.vest]\nmesh = \"sheet.obj\"\non = \"box\"\noffset = [0.1, 0, 0]\n";
  const Planned plan = planned({"primary.box.ignore=[\"hand_*\"]", "cloth.sheet.ignores=[\"thumb_?\", \"*_r\"]"}, vest);
  ASSERT_EQ(plan.ignores.size(), 2u) << text(plan.dry);
  EXPECT_EQ(plan.ignores[0], (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(plan.ignores[1], (std::vector<int>{1, 2}));
  const std::string dry = text(plan.dry);
  EXPECT_NE(dry.find("cloth does not meet 2 of the 4 parts of \"box\": \"Hand_L\", \"Hand_R\""), std::string::npos)
      << dry;
  EXPECT_NE(dry.find("cloth \"sheet\" does not meet 2 of the 4 parts of \"box\": \"Hand_R\", \"thumb_r\""),
            std::string::npos)
      << dry;
}

TEST(IgnoredParts, Without_the_keys_all_parts_are_met) {
  const Planned plan = planned({});
  ASSERT_EQ(plan.ignores.size(), 1u) << text(plan.dry);
  EXPECT_TRUE(plan.ignores[0].empty());
  EXPECT_EQ(text(plan.dry).find("not meet"), std::string::npos);
}

TEST(IgnoredParts, A_pattern_that_names_no_part_is_refused_with_the_nearest_or_all_of_them) {
  const Planned slip = planned({"primary.box.ignore=[\"hnd_l*\"]"});
  EXPECT_EQ(slip.dry.exit_code, 2);
  EXPECT_NE(text(slip.dry).find("primary \"box\""), std::string::npos) << text(slip.dry);
  EXPECT_NE(text(slip.dry).find("ignore = \"hnd_l*\" names no part of \"box\""), std::string::npos) << text(slip.dry);
  EXPECT_NE(text(slip.dry).find("did you mean \"Hand_L\"?"), std::string::npos) << text(slip.dry);
  const Planned other = planned({"cloth.sheet.ignores=[\"wing*\"]"});
  EXPECT_EQ(other.dry.exit_code, 2);
  EXPECT_NE(text(other.dry).find("cloth \"sheet\""), std::string::npos) << text(other.dry);
  EXPECT_NE(text(other.dry).find("known: spine, Hand_L, Hand_R, thumb_r"), std::string::npos) << text(other.dry);
}

}  // namespace
}  // namespace ft::test
