// Preview and final: what the user is told, and that one is not taken for the other.
#include "baker/plan/quality.h"

#include "baker/systems/cloth/cloth_quality.h"
#include "tests/baker/fake_bake.h"
#include "tests/support/scripted_body.h"

namespace ft::test {
namespace {

TEST(Quality, A_preview_says_so_and_is_stale_for_a_final_bake) {
  FakeScene scene;
  scene.write_shot(4);
  BakeOptions preview = scene.options();
  preview.overrides.push_back("shot.quality=preview");
  ASSERT_EQ(scene.run(preview).exit_code, 0);
  EXPECT_NE(scene.manifest_text().find("preview quality"), std::string::npos);
  EXPECT_NE(text(scene.run(preview)).find("up to date"), std::string::npos);
  BakeOptions final_bake = scene.options();
  final_bake.explain = true;
  const std::string why = text(scene.run(final_bake));
  EXPECT_NE(why.find("quality"), std::string::npos) << why;
  final_bake.explain = false;
  ASSERT_EQ(scene.run(final_bake).exit_code, 0);
  EXPECT_EQ(scene.manifest_text().find("preview quality"), std::string::npos);
}

TEST(Quality, A_preview_takes_the_place_of_a_finished_final_bake_only_when_forced) {
  FakeScene scene;
  scene.write_shot(4);
  ASSERT_EQ(scene.run(scene.options()).exit_code, 0);
  const auto before = scene.products();
  BakeOptions preview = scene.options();
  preview.overrides.push_back("shot.quality=preview");
  const BakeResult refused = scene.run(preview);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(text(refused).find("there is a finished bake in final quality, which a preview would replace (bake the "
                               "preview into a folder of its own with --out, or replace the bake with --force)"),
            std::string::npos)
      << text(refused);
  EXPECT_EQ(scene.products(), before);
  preview.explain = true;
  EXPECT_NE(text(scene.run(preview)).find("this bake would be refused"), std::string::npos);
  preview.explain = false;
  preview.force = true;
  EXPECT_EQ(scene.run(preview).exit_code, 0);
  EXPECT_NE(scene.manifest_text().find("preview quality"), std::string::npos);
}

TEST(Quality, A_preview_is_coarser_in_everything_and_a_final_bake_in_nothing) {
  Shot shot;
  ClothSetup final_setup, preview_setup;
  apply_quality(shot, final_setup);
  EXPECT_EQ(final_setup.coarsen, 1);
  EXPECT_EQ(final_setup.travel, ClothSetup{}.travel);
  EXPECT_EQ(final_setup.min_substeps, ClothSetup{}.min_substeps);
  shot.quality = "preview";
  apply_quality(shot, preview_setup);
  EXPECT_GT(preview_setup.coarsen, 1);
  EXPECT_GT(preview_setup.travel, final_setup.travel);
  EXPECT_LT(preview_setup.min_substeps, final_setup.min_substeps);
  EXPECT_GT(preview_setup.linear_tolerance, final_setup.linear_tolerance);
  EXPECT_GT(preview_setup.feasible.max_edge, final_setup.feasible.max_edge);
}

TEST(Quality, A_preview_of_what_is_sewn_keeps_the_substeps_as_its_seams_keep_their_edges) {
  Shot shot;
  shot.quality = "preview";
  ClothSetup setup;
  setup.garments.resize(2);
  setup.garments[1].mesh.stitches.push_back({});
  apply_quality(shot, setup);
  EXPECT_GT(setup.coarsen, 1);
  EXPECT_EQ(setup.min_substeps, ClothSetup{}.min_substeps);
}

TEST(Quality, A_preview_moves_in_a_coarser_body) {
  Surface ball;
  std::vector<Vec3> bind;
  make_sphere(0.15, 60, 120, bind, ball.triangles);
  Shot shot;
  ClothSetup setup;
  setup.primary = std::make_shared<ScriptedBody>(ball, bind, 0, [](double, std::span<Vec3>) {});
  apply_quality(shot, setup);
  EXPECT_EQ(with_quality(shot, setup, setup.primary), setup.primary);
  shot.quality = "preview";
  apply_quality(shot, setup);
  EXPECT_LT(2 * with_quality(shot, setup, setup.primary)->surface().triangles.size(), ball.triangles.size());
}

TEST(Quality, A_word_that_is_no_quality_is_refused) {
  FakeScene scene;
  scene.write_shot(4);
  BakeOptions options = scene.options();
  options.overrides.push_back("shot.quality=draft");
  const BakeResult refused = scene.run(options);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(text(refused).find("preview"), std::string::npos) << text(refused);
}

}  // namespace
}  // namespace ft::test
