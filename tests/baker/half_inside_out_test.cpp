// A body of which one half is wound the other way, as after mirroring half of a model: it bakes as the whole one.
#include <gtest/gtest.h>

#include "baker/plan/inputs.h"
#include "baker/record/manifest.h"
#include "baker/run/interaction.h"
#include "io/import/import.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

TEST(HalfInsideOut, Body_weighs_and_pushes_as_the_whole_one_does_slow) {
  const auto shot = assets_root() / "faults/body_half_inside_out/shot.toml";
  FT_REQUIRE_FILE(shot);
  ShotFaults faults;
  auto inputs = read_inputs(shot, {}, std::nullopt, faults);
  ASSERT_TRUE(inputs) << inputs.error().text();
  const auto plan = make_plan(std::move(*inputs), import_primary, {});
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_NEAR(plan->primaries.at(0).mass.kilograms, 86.34, 0.02);
  EXPECT_EQ(plan->primaries[0].mass.note(), "");

  const ScratchFolder scratch;
  BakeOptions options;
  options.shot_file = shot, options.folder = scratch / "out";
  RecordedProgress progress;
  const BakeResult done = bake(options, {import_primary, make_group_solver}, progress);
  ASSERT_EQ(done.exit_code, 0) << text(done);
  EXPECT_NE(progress.notes.find("disagree about which way is out"), std::string::npos) << progress.notes;
  const auto manifest = read_manifest(options.folder);
  ASSERT_TRUE(manifest) << manifest.error().text();
  for (const FrameReport& frame : manifest->frames) {
    EXPECT_EQ(frame.inside_body, 0) << frame.frame;
    EXPECT_EQ(frame.deepest_drawn, 0) << frame.frame;
    EXPECT_EQ(frame.crossings_body + frame.crossings_self, 0) << frame.frame;
  }
  const auto rows = interactions(*manifest, plan->primaries);
  ASSERT_FALSE(rows.empty());
  EXPECT_NEAR(rows[0].torque.mean, 0.21, 0.02);  // 5.34 of the body as the file has it
}

}  // namespace
}  // namespace ft::test
