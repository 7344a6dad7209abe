// A primary that jumps: who is told of it.
#include <gtest/gtest.h>

#include "tests/baker/fake_bake.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

/// A box that is 3 m further on from frame 7.
std::unique_ptr<Trajectory> jumping_box(const Trajectory& box, const ImportRequest& request) {
  std::vector<Vec3> bind(8);
  box.bind_pose(bind);
  const auto move = [fps = request.shot_fps](double time, std::span<Vec3> x) {
    if (time * fps > 5.5)
      for (Vec3& p : x) p.x() += 3;
  };
  return std::make_unique<ScriptedBody>(box.surface(), bind, box.preroll(), move);
}

TEST(Teleports, are_told_by_the_dry_run_the_progress_and_the_manifest) {
  test::FakeScene scene;
  scene.write_shot(10);
  test::RecordedProgress progress;
  const BakeServices services = scene.services({.move = jumping_box});
  BakeOptions options = scene.options();
  const std::string expected = "jumps 3.00 m between frames 6 and 7: the cloth is carried along";
  options.dry_run = true;
  std::string dry;
  for (const std::string& line : bake(options, services, progress).lines) dry += line + "\n";
  EXPECT_NE(dry.find(expected), std::string::npos) << dry;
  options.dry_run = false;
  EXPECT_EQ(bake(options, services, progress).exit_code, 0);
  EXPECT_NE(progress.notes.find(expected), std::string::npos) << progress.notes;
  EXPECT_NE(scene.manifest_text().find(expected), std::string::npos);
}

}  // namespace
}  // namespace ft
