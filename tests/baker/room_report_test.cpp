// The clip is looked at before the bake: which parts leave the cloth no room, in which frames, and who is told.
#include "baker/plan/room_report.h"

#include <gtest/gtest.h>

#include "baker/core/file.h"
#include "tests/baker/fake_bake.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

/// A box of 1 m and a ball of 20 cm that is 8 cm inside it at frames 4 to 6, and far away otherwise.
std::unique_ptr<Trajectory> box_and_ball(const Trajectory& box, const ImportRequest& request) {
  Surface surface = box.surface();
  std::vector<Vec3> points(8);
  box.bind_pose(points);
  make_sphere(0.1, 12, 16, points, surface.triangles);
  for (std::size_t i = 8; i < points.size(); ++i) points[i] += Vec3(2, 0.5, 0.5);
  surface.parts = {{"box", -1, 1.0}, {"ball", -1, 0.004}};
  surface.part_of_vertex.resize(points.size(), 1);
  return std::make_unique<ScriptedBody>(surface, points, box.preroll(),
                                        [fps = request.shot_fps](double time, std::span<Vec3> x) {
                                          const double frame = 1 + time * fps;
                                          if (frame > 3.5 && frame < 6.5)
                                            for (std::size_t i = 8; i < x.size(); ++i) x[i].x() -= 2 - 1.02;
                                        });
}

TEST(Room, is_looked_for_before_the_bake_and_told) {
  test::FakeScene scene;
  scene.write_shot(10);
  test::RecordedProgress progress;
  const BakeServices services = scene.services({.move = box_and_ball});
  BakeOptions options = scene.options();
  options.overrides.push_back("primary.box.teleports=ignore");
  options.dry_run = true;
  std::string dry;
  for (const std::string& line : bake(options, services, progress).lines) dry += line + "\n";
  EXPECT_NE(dry.find("no room: \"ball\" of \"box\" is 80.0 mm inside \"box\", frames 4-6"), std::string::npos) << dry;
  EXPECT_EQ(dry.find("more places"), std::string::npos) << dry;
  EXPECT_NE(dry.find("absent for the cloth: "), std::string::npos) << dry;
  EXPECT_NE(dry.find(" % of \"ball\" of \"box\" at worst, frames 4-6"), std::string::npos) << dry;
  EXPECT_NE(dry.find(" (inside \"box\")"), std::string::npos) << dry;
  options.dry_run = false;
  EXPECT_EQ(bake(options, services, progress).exit_code, 0);
  EXPECT_NE(progress.notes.find("no room"), std::string::npos) << progress.notes;
  const auto text = read_text(scene.folder().report());
  ASSERT_TRUE(text);
  const auto report = parse_json(*text, "report");
  ASSERT_TRUE(report);
  const Json& places = report->at("room").at("places");
  ASSERT_EQ(places.size(), 1u);
  EXPECT_EQ(places[0].at("first_frame"), 4);
  EXPECT_EQ(places[0].at("last_frame"), 6);
  EXPECT_NEAR(places[0].at("clearance").get<double>(), -0.08, 1e-3);
  const Json& absent = report->at("room").at("absent");
  ASSERT_EQ(absent.size(), 1u);
  EXPECT_EQ(absent[0].at("part"), "ball");
  EXPECT_EQ(absent[0].at("inside"), "box");
  EXPECT_EQ(absent[0].at("first_frame"), 4);
  EXPECT_EQ(absent[0].at("last_frame"), 6);
  EXPECT_GT(absent[0].at("share").get<double>(), 0.1);
  EXPECT_LT(absent[0].at("share").get<double>(), 0.9);
}

TEST(Room, What_the_shot_has_ignored_leaves_room_and_is_not_told_to_be_absent) {
  test::FakeScene scene;
  scene.write_shot(10);
  Progress silent;
  BakeOptions options = scene.options();
  options.overrides = {"primary.box.teleports=ignore", "primary.box.ignore=[\"ball\"]"};
  options.dry_run = true;
  std::string dry;
  for (const std::string& line : bake(options, scene.services({.move = box_and_ball}), silent).lines)
    dry += line + "\n";
  EXPECT_EQ(dry.find("no room"), std::string::npos) << dry;
  EXPECT_EQ(dry.find("absent for the cloth"), std::string::npos) << dry;
  EXPECT_NE(dry.find("cloth does not meet 1 of the 2 parts of \"box\": \"ball\""), std::string::npos) << dry;
}

}  // namespace
}  // namespace ft
