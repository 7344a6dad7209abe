// Curves through the conductor: written, judged, said by info, compared. tests/baker/resume_test.cpp interrupts them.
#include <cmath>
#include <functional>

#include "baker/commands/command_line.h"
#include "baker/commands/compare.h"
#include "baker/commands/compare_report.h"
#include "baker/core/file.h"
#include "baker/judge/judge_caches.h"
#include "baker/record/cache_track.h"
#include "io/cache/cache.h"
#include "tests/baker/fake_bake.h"
#include "tests/baker/tress_kind.h"

namespace ft::test {
namespace {

class CurvesBake : public ShapesBakeTest {
 protected:
  CurvesBake() : ShapesBakeTest(Beside::k_tress, "locks") {}
  static std::string info_of(const std::filesystem::path& path) {
    std::string words[] = {"followthrough", "info", path.string()};
    char* arguments[] = {words[0].data(), words[1].data(), words[2].data()};
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_command_line(3, arguments), 0);
    return testing::internal::GetCapturedStdout();
  }
  static CompareReport of_locks(const std::vector<CompareReport>& reports, const std::string& extension) {
    for (const CompareReport& r : reports)
      if (r.system == "locks" && r.a.ends_with(extension)) return r;
    ADD_FAILURE() << "no report of the curves";
    return {};
  }
};

TEST_F(CurvesBake, Every_frame_has_the_strands_where_the_solver_has_them) {
  RecordedProgress progress;
  ASSERT_EQ(bake(scene_.options(), scene_.services(), progress).exit_code, 0);
  EXPECT_EQ(progress.start.vertex_count, 9 + 20 * 8);  // of the sheet, and of the strands
  auto reader = open_cache_of_any_shape(scene_.folder().path / "locks.abc");
  ASSERT_TRUE(reader) << reader.error().text();
  const CombedBall ball = TressSpec().ball();
  EXPECT_EQ((*reader)->info().curves.curve_count(), 20);
  EXPECT_EQ((*reader)->info().curves.ids, combed_curves(ball).ids);
  FrameData frame;
  for (int f = 0; f < 10; ++f) {
    ASSERT_TRUE((*reader)->read(f, frame));
    const std::vector<Vec3> x = combed_places(ball, k_tress_step * (f + 3));  // three frames of pre-roll
    ASSERT_EQ(frame.positions.size(), x.size());
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(frame.positions[i], x[i].cast<float>()) << f << " " << i;
  }
}

TEST_F(CurvesBake, Info_says_how_many_strands_and_vertices_there_are) {
  ASSERT_EQ(scene_.run().exit_code, 0);
  const std::string of_bake = info_of(scene_.folder().path);
  EXPECT_NE(of_bake.find("tress \"locks\": 20 strands, 160 vertices: locks.abc"), std::string::npos) << of_bake;
  const std::string of_cache = info_of(scene_.folder().path / "locks.abc");
  EXPECT_NE(of_cache.find("10 frames from 1 at 24 fps, 160 vertices"), std::string::npos) << of_cache;
  EXPECT_NE(of_cache.find("20 strands of 8 vertices, 0.133 to 0.4 mm wide, with ids, with velocities"),
            std::string::npos)
      << of_cache;
}

TEST_F(CurvesBake, Check_reads_every_frame_and_refuses_what_is_not_the_manifests) {
  ASSERT_EQ(scene_.run().exit_code, 0);
  const std::string good = scene_.manifest_text();
  EXPECT_EQ(judged(), "");
  using System = ManifestSystem;
  const std::vector<std::pair<std::function<void(System&)>, const char*>> lies = {
      {[](System& s) { s.curve_count = 21; }, "has 20 curves of 160 vertices, the manifest says 21 of 160"},
      {[](System& s) { s.count = 159; }, "has 20 curves of 160 vertices, the manifest says 20 of 159"},
      {[](System& s) { s.shape = OutputShape::k_instances; }, "holds curves, the manifest says instances"}};
  for (const auto& [lie, words] : lies) {
    falsify(lie);
    EXPECT_NE(judged().find(words), std::string::npos) << judged();
    ASSERT_TRUE(write_text_durably(scene_.folder().manifest(), good));
  }
  const auto cache = scene_.folder().path / "locks.abc";
  std::filesystem::resize_file(cache, std::filesystem::file_size(cache) / 2);
  EXPECT_NE(judged(), "");
}

TEST_F(CurvesBake, The_cache_that_holds_curves_is_opened_wherever_it_stands_in_the_list) {
  BakeOptions options = scene_.options();
  options.overrides = {"cache.formats=[\"pc2\", \"abc\"]"};
  const BakeResult done = scene_.run(options);
  ASSERT_EQ(done.exit_code, 0) << text(done);
  const auto manifest = read_manifest(scene_.folder().path);
  ASSERT_TRUE(manifest);
  const auto locks = std::ranges::find(manifest->systems, "locks", &ManifestSystem::name);
  ASSERT_NE(locks, manifest->systems.end());
  ASSERT_EQ(locks->caches.front().format, "pc2");
  const auto track = open_track(scene_.folder().path, *locks, *manifest);
  ASSERT_TRUE(track) << track.error().text();
  EXPECT_EQ(track->shape(), OutputShape::k_curves);
  EXPECT_EQ(track->reader->info().curves.curve_count(), 20);
}

TEST_F(CurvesBake, Bakes_that_differ_in_order_alone_are_equal) {
  const auto a = bake_with("a", {}), b = bake_with("b", {"tress.locks.turned=true"});
  const CompareReport r = of_locks(compare_paths(a, b, 0), ".abc");
  EXPECT_EQ(r.verdict, CompareVerdict::k_equal) << r.reason;
  EXPECT_EQ(summary(r), "no difference at all");
  ASSERT_TRUE(r.curves.has_value());
  EXPECT_EQ(r.curves->common, 20);
  EXPECT_TRUE(r.curves->by_id && r.curves->same_set());
}

TEST_F(CurvesBake, Of_another_swing_the_roots_stay_and_the_tips_do_not) {
  const auto a = bake_with("a", {}), b = bake_with("b", {"tress.locks.swing=0.4"});
  const CompareReport r = of_locks(compare_paths(a, b, 1e-6), ".abc");
  EXPECT_EQ(r.verdict, CompareVerdict::k_different);
  EXPECT_EQ(r.curves->root_max, 0);
  ASSERT_GE(r.worst, 0);
  EXPECT_TRUE(r.element(r.frames[at(r.worst)].vertex).ends_with("vertex 7")) << summary(r);
  for (const LengthRatios* lengths : {&r.curves->lengths_a, &r.curves->lengths_b}) {
    EXPECT_EQ(lengths->count, 200u);
    EXPECT_NEAR(lengths->mean, 1, 1e-6);  // single precision of places about half a metre from the origin
    EXPECT_LT(lengths->p99, 1e-5);
  }
}

}  // namespace
}  // namespace ft::test
