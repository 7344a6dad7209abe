// Curves in the preview page: how many, where, and what is said where only a share of them is there.
#include <cmath>
#include <cstring>

#include "baker/commands/preview.h"
#include "baker/commands/preview_bake.h"
#include "baker/commands/preview_curves.h"
#include "tests/preview/ask_page.h"
#include "tests/support/combed_bake.h"

namespace ft {
namespace {

using test::CombedBall;
using test::ScratchFolder;

constexpr int k_frames = 10;

CombedBall small_ball() {
  CombedBall out;
  out.strands = 60, out.vertices = 9;
  return out;
}

/// What base64_of() was made of.
template <class T>
std::vector<T> numbers(const Json& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int known = 0;
  for (const char c : text.get<std::string>()) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    known += 6;
    if (known < 8) continue;
    known -= 8;
    bytes += static_cast<char>(bits >> known & 255);
  }
  std::vector<T> out(bytes.size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
  return out;
}

/// Vertex i of the page in a frame, as the page computes it.
Vec3 shown(const Json& system, int frame, int i) {
  const auto packed = numbers<std::uint16_t>(system["positions"]);
  const auto bounds = numbers<double>(system["curves"]["bounds"]);
  Vec3 out;
  for (int k = 0; k < 3; ++k)
    out[k] = bounds[at(6 * frame + k)] +
             packed[at((frame * system["vertices"].get<int>() + i) * 3 + k)] * bounds[at(6 * frame + 3 + k)];
  return out;
}

Vec3 baked(const CombedBall& ball, int frame, int i) {
  return test::combed_places(ball, 2 * std::numbers::pi * frame / test::k_combed_swing)[at(i)];
}

constexpr double k_half_step = 0.5 * 0.6 / 65535;  ///< the hair is at most 0.6 m long, wide or deep

TEST(PreviewCurves, Holds_every_strand_with_its_vertices_widths_and_id) {
  const ScratchFolder folder;
  const CombedBall ball = small_ball();
  test::write_combed_bake(folder.path(), ball, k_frames);
  const auto bake = preview_bake(folder.path());
  ASSERT_TRUE(bake) << bake.error().text();
  ASSERT_EQ((*bake)["systems"].size(), 2u);
  const Json& tress = (*bake)["systems"][1];
  EXPECT_EQ(tress["vertices"], 60 * 9);
  EXPECT_EQ(tress["curves"]["strands"], 60);
  EXPECT_FALSE(tress["curves"].contains("note"));
  EXPECT_EQ(numbers<std::uint32_t>(tress["curves"]["counts"]), std::vector<std::uint32_t>(60, 9));
  const auto ids = numbers<std::uint32_t>(tress["curves"]["ids"]);
  ASSERT_EQ(ids.size(), 60u);
  EXPECT_EQ(ids[0], 1000u);
  EXPECT_EQ(ids[59], 1118u);
  EXPECT_EQ(numbers<float>(tress["curves"]["widths"]), test::combed_curves(ball).widths);
  EXPECT_EQ(numbers<std::uint16_t>(tress["positions"]).size(), at(3 * 60 * 9 * k_frames));
  for (const int frame : {0, 4, 9})
    for (const int i : {0, 8, 300, 539})
      EXPECT_LT((shown(tress, frame, i) - baked(ball, frame, i)).cwiseAbs().maxCoeff(), k_half_step)
          << frame << " " << i;
}

TEST(PreviewCurves, Are_as_fine_where_the_whole_shot_is_wide) {
  const ScratchFolder folder;
  const Vec3 drift(5, 0, -3);
  test::write_combed_bake(folder.path(), small_ball(), k_frames, drift);
  const auto bake = preview_bake(folder.path());
  ASSERT_TRUE(bake) << bake.error().text();
  const Json& tress = (*bake)["systems"][1];
  EXPECT_GT(tress["step"][0].get<double>(), 6e-4);  // between the bounds of the shot it would be coarse
  // Single precision at 45 m is 2 um to either side.
  for (const int i : {0, 8, 300})
    EXPECT_LT((shown(tress, 9, i) - (baked(small_ball(), 9, i) + 9 * drift)).cwiseAbs().maxCoeff(), k_half_step + 2e-6)
        << i;
}

TEST(PreviewCurves, A_share_of_the_strands_is_evenly_chosen) {
  EXPECT_EQ(chosen_strands(10, 1), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(chosen_strands(10, 0.5), (std::vector<int>{1, 3, 5, 7, 9}));
  EXPECT_EQ(chosen_strands(9, 0.34), (std::vector<int>{1, 4, 7}));
  EXPECT_EQ(chosen_strands(10, 1e-9), (std::vector<int>{5}));
  EXPECT_TRUE(chosen_strands(0, 0.5).empty());
  for (const int count : {7, 100, 12345})
    for (const double share : {0.03, 0.5, 0.77}) {
      const std::vector<int> chosen = chosen_strands(count, share);
      for (std::size_t i = 1; i < chosen.size(); ++i) {
        const double step = static_cast<double>(count) / static_cast<double>(chosen.size());
        EXPECT_LT(std::abs(chosen[i] - chosen[i - 1] - step), 1) << count << " " << share;
      }
    }
}

TEST(PreviewCurves, Where_the_page_has_no_room_for_all_it_holds_a_share_and_page_and_log_say_so) {
  const ScratchFolder folder;
  const CombedBall ball = small_ball();
  test::write_combed_bake(folder.path(), ball, k_frames);
  const int each = 9 * k_frames * 8;  // bytes of a strand in the page
  const auto bake = preview_bake(folder.path(), 20.5 * each);
  ASSERT_TRUE(bake) << bake.error().text();
  const Json& tress = (*bake)["systems"][1];
  EXPECT_EQ(tress["vertices"], 20 * 9);
  EXPECT_EQ(tress["curves"]["strands"], 60);
  const auto ids = numbers<std::uint32_t>(tress["curves"]["ids"]);
  ASSERT_EQ(ids.size(), 20u);
  EXPECT_EQ(ids[3], 1000u + 2 * 10);  // one of three, the middle one
  EXPECT_LT((shown(tress, 5, 3 * 9 + 4) - baked(ball, 5, 10 * 9 + 4)).cwiseAbs().maxCoeff(), k_half_step);
  EXPECT_LE(tress["positions"].get<std::string>().size(), at(20 * each));
  const std::string note =
      "\"tress\": 20 of 60 strands are drawn, evenly chosen and wider; all of them would take 0 MB of the page";
  EXPECT_EQ(tress["curves"]["note"], note);

  PreviewOptions options{{folder.path()}, folder / "page.html"};
  options.curve_megabytes = 20.5e-6 * each;
  testing::internal::CaptureStdout();
  ASSERT_EQ(run_preview(options), 0);
  const std::string log = testing::internal::GetCapturedStdout();
  EXPECT_NE(log.find("note: " + note + "\n"), std::string::npos) << log;
  options.curve_megabytes = 1;
  testing::internal::CaptureStdout();
  ASSERT_EQ(run_preview(options), 0);
  EXPECT_EQ(testing::internal::GetCapturedStdout().find("note:"), std::string::npos);
  // Two bakes share what there is.
  options.folders.push_back(folder.path());
  options.curve_megabytes = 41e-6 * each;
  const auto page = preview_page(options);
  ASSERT_TRUE(page) << page.error().text();
  EXPECT_EQ(page->notes.size(), 2u);
}

TEST(PreviewCurves, Are_drawn_where_the_cache_has_them_and_counted_slow) {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed";
  const ScratchFolder folder;
  const CombedBall ball = small_ball();
  test::write_combed_bake(folder.path(), ball, k_frames);
  PreviewOptions options{{folder.path()}, folder / "page.html"};
  options.curve_megabytes = 20.5e-6 * 9 * k_frames * 8;
  ASSERT_EQ(run_preview(options), 0);
  const auto answer = test::ask_page(options.output, "frame=106&test=tress:0,31");
  ASSERT_TRUE(answer.is_object());
  EXPECT_TRUE(answer["drawn"].get<bool>());
  EXPECT_EQ(answer["frame"], 106);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(answer["vertices"]["tress"][0][at(k)].get<double>(), baked(ball, 5, 9)[k], k_half_step);
    EXPECT_NEAR(answer["vertices"]["tress"][1][at(k)].get<double>(), baked(ball, 5, 10 * 9 + 4)[k], k_half_step);
  }
  const std::string systems = answer["systems"];
  EXPECT_NE(systems.find("60 strands, 180 vertices drawn"), std::string::npos) << systems;
  EXPECT_NE(systems.find("20 of 60 strands are drawn, evenly chosen and wider"), std::string::npos) << systems;
  EXPECT_TRUE(answer["faults"].empty()) << answer["faults"];  // of shaders
  EXPECT_GE(answer["triangles"], 179 * 8 + 1472);             // four pieces between any two vertices, and the ball
}

}  // namespace
}  // namespace ft
