// What of the collider a cloth does not meet: from marks to the manifest and back, and left out of what is judged.
#include "baker/systems/interface/absent_runs.h"

#include <gtest/gtest.h>

#include "baker/judge/judge_caches.h"
#include "baker/record/manifest.h"
#include "baker/record/report_json.h"
#include "tests/baker/fake_bake.h"

namespace ft {
namespace {

TEST(AbsentRuns, Marks_become_runs_and_runs_become_marks) {
  const std::vector<char> marks = {1, 1, 0, 0, 1, 0, 1, 1, 1};
  const AbsentRuns runs = runs_of("dress", marks);
  EXPECT_EQ(runs.runs, (std::vector<std::array<int, 2>>{{0, 2}, {4, 1}, {6, 3}}));
  EXPECT_EQ(vertex_count(runs), 6);
  EXPECT_EQ(marks_of(runs, 9), marks);
  EXPECT_TRUE(runs_of("dress", std::vector<char>(9, 0)).runs.empty());
  EXPECT_TRUE(runs_of("dress", {}).runs.empty());
  EXPECT_EQ(marks_of({"dress", {{7, 2'000'000'000}, {2'000'000'000, 3}}}, 9),
            (std::vector<char>{0, 0, 0, 0, 0, 0, 0, 1, 1}));
}

TEST(AbsentRuns, Go_through_a_report_as_json_and_are_not_there_when_empty) {
  FrameReport report;
  EXPECT_FALSE(to_json(report).contains("absent"));
  report.absent = {{"dress", {{3, 2}, {9, 1}}}, {"cape", {{0, 5}}}};
  const Json json = to_json(report);
  EXPECT_EQ(json.at("absent").dump(), R"([{"system":"dress","runs":[3,2,9,1]},{"system":"cape","runs":[0,5]}])");
  const auto back = frame_report_from_json(json);
  ASSERT_TRUE(back);
  EXPECT_EQ(to_json(*back), json);
  EXPECT_EQ(merge(*back, FrameReport()).absent.size(), 2u);
  for (const char* bad : {R"({"absent":3})", R"({"absent":[{"runs":[1]}]})", R"({"absent":[{"runs":[-1,2]}]})",
                          R"({"absent":[{"system":"a"}]})", R"({"absent":[{"system":"a","runs":["b",1]}]})"})
    EXPECT_FALSE(frame_report_from_json(Json::parse(bad))) << bad;
}

/// The sheet through the wall x = 1 of the box, whose vertices are all absent for it, or none.
CacheJudgement judged(bool absent, const test::FakeScene& scene) {
  test::FakeBehaviour behaviour;
  behaviour.absent = absent;
  EXPECT_EQ(scene.run(scene.options(), behaviour).exit_code, 0);
  auto judgement = judge_caches(scene.folder().path);
  EXPECT_TRUE(judgement.ok());
  return std::move(*judgement);
}

TEST(AbsentRuns, A_crossing_with_what_is_absent_for_the_cloth_is_none) {
  test::FakeScene scene;
  Mesh through = test::FakeScene::sheet();
  for (Vec3& p : through.positions) p += Vec3(-0.3 + 0.4 * p.z(), 0.1, 0.1);
  scene.write_garment(through);
  scene.write_shot(3);
  const CacheJudgement met = judged(false, scene);
  ASSERT_FALSE(met.frames.empty());
  for (const FrameReport& frame : met.frames) {
    EXPECT_GT(frame.crossings_body, 0);
    EXPECT_EQ(frame.absent_vertices, 0);
  }
  EXPECT_EQ(scene.manifest_text().find("\"absent\""), std::string::npos);
  std::filesystem::remove_all(scene.folder().path);
  const CacheJudgement not_met = judged(true, scene);
  ASSERT_EQ(not_met.frames.size(), met.frames.size());
  for (std::size_t i = 0; i < met.frames.size(); ++i) {
    EXPECT_EQ(not_met.frames[i].crossings_body, 0);
    EXPECT_EQ(not_met.frames[i].crossings_absent, met.frames[i].crossings_body);
    EXPECT_EQ(not_met.frames[i].absent_vertices, 8);
  }
  EXPECT_NE(scene.manifest_text().find(R"("absent":[{"system":"sheet","runs":[0,8]}])"), std::string::npos)
      << scene.manifest_text();
  const auto manifest = read_manifest(scene.folder().path);
  ASSERT_TRUE(manifest);
  EXPECT_EQ(manifest->frames[0].crossings_body, 0);  // where the bake starts, too
  EXPECT_GT(manifest->frames[0].crossings_absent, 0);
}

}  // namespace
}  // namespace ft
