// Buttons and zips from the shot file to the caches, with the real solver: a vest hangs on a sheet by its upper edge
// and is unbuttoned from one end.
#include <csignal>

#include "baker/judge/judge_caches.h"
#include "io/cache/cache.h"
#include "solvers/validation/scene_parts.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

constexpr int k_cells = 6, k_row = k_cells + 1;
constexpr double k_gap = 6e-3;  ///< between the two in the bind pose [m]
const char* const k_pinned = "pins = [ { vertices = \"0-6\" } ]";

/// Two squares of 30 cm beside the bobbing box: the sheet is held to it by its upper edge.
class Buttoned : public testing::Test {
 protected:
  Buttoned() {
    scene_.write_garment(
        rectangle_mesh(k_cells, k_cells, [](double s, double t) { return Vec3(1.02, 0.9 - 0.3 * t, 0.3 + 0.3 * s); }));
  }
  void write(const std::string& vest_lines, const std::string& sheet_lines = k_pinned, int last_frame = 16) {
    scene_.write_shot(
        last_frame, sheet_lines,
        "[cloth.vest]\nmesh = \"sheet.obj\"\noffset = [" + std::to_string(gap_) + ", 0, 0]\n" + vest_lines + "\n");
  }
  BakeServices services() const {
    BakeServices out = scene_.services();
    out.make_solver = make_group_solver;
    return out;
  }
  BakeResult run(const BakeOptions& options, Progress&& progress = Progress()) const {
    return bake(options, services(), progress);
  }
  BakeResult run() const { return run(scene_.options()); }
  /// Distances of the vest's upper edge from the sheet's, at a frame of the shot [m].
  std::vector<double> gaps(int frame) const {
    std::vector<Vec3f> sheet, vest;
    for (const auto& [name, x] : {std::pair{"sheet.pc2", &sheet}, {"vest.pc2", &vest}}) {
      auto cache = open_cache(scene_.folder().path / name);
      EXPECT_TRUE(cache);
      EXPECT_TRUE((*cache)->read_frame(frame - 1, *x));
    }
    std::vector<double> out;
    for (int i = 0; i < k_row; ++i) out.push_back(double{(sheet[at(i)] - vest[at(i)]).norm()});
    return out;
  }
  void expect_fault(const std::string& vest_lines, int exit_code, const std::string& words,
                    const std::string& sheet_lines = k_pinned) {
    write(vest_lines, sheet_lines);
    const BakeResult result = run();
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_NE(text(result).find(words), std::string::npos) << text(result);
  }
  FakeScene scene_;
  double gap_ = k_gap;  ///< in the shot file [m]
};

const char* const k_zip = "pins = [ { vertices = \"0-6\", to = \"sheet\", until = 4, fade = 8, opens = [0, 0, 1] } ]";

TEST_F(Buttoned, A_vest_hangs_on_its_buttons_is_opened_from_one_end_and_falls) {
  write(k_zip);
  ASSERT_EQ(run().exit_code, 0) << text(run());
  for (const double gap : gaps(4)) EXPECT_LT(gap, k_gap + 1e-3);
  const auto half = gaps(8);
  for (int i = 4; i < k_row; ++i) EXPECT_LT(half[at(i)], k_gap + 1e-3) << i;
  EXPECT_GT(gaps(12)[0], 2 * k_gap);  // it hangs on its neighbours at first; 60 mm where Newton converges
  for (const double gap : gaps(16)) EXPECT_GT(gap, 0.1);  // 180 to 320 mm where Newton converges
  const auto judged = judge_caches(scene_.folder().path);
  ASSERT_TRUE(judged) << judged.error().text();
  for (const FrameReport& frame : judged->frames) EXPECT_EQ(frame.crossings_self + frame.crossings_body, 0);
  EXPECT_NE(text(run()).find("up to date"), std::string::npos);
  BakeOptions later = scene_.options();
  later.overrides.push_back("cloth.vest.pins=[{vertices=\"0-6\",to=\"sheet\",until=5,fade=8,opens=[0,0,1]}]");
  later.explain = true;
  EXPECT_NE(text(run(later)).find("stale: cloth.vest.pins changed"), std::string::npos) << text(run(later));
}

TEST_F(Buttoned, How_far_it_falls_does_not_hang_on_hundredths_of_a_millimetre) {
  for (const double gap : {5.9e-3, 5.94e-3, 5.96e-3, 6.04e-3, 6.06e-3, 6.1e-3}) {
    gap_ = gap;
    write(k_zip);
    ASSERT_EQ(run().exit_code, 0) << text(run());
    for (const double fallen : gaps(16)) EXPECT_GT(fallen, 0.1) << gap;
  }
}

TEST_F(Buttoned, Interrupted_while_it_opens_it_goes_on_to_the_same_bytes) {
  write(k_zip, k_pinned, 10);
  BakeOptions whole = scene_.options();
  whole.folder = scene_.file("whole");
  ASSERT_EQ(run(whole).exit_code, 0);
  RecordedProgress progress;
  progress.on_frame = [](int f) { f == 7 ? void(std::raise(SIGINT)) : void(); };
  ASSERT_EQ(run(scene_.options(), std::move(progress)).exit_code, 130);
  BakeOptions options = scene_.options();
  options.resume = true;
  ASSERT_EQ(run(options).exit_code, 0);
  EXPECT_EQ(scene_.products(), scene_.products(whole.folder));
}

TEST_F(Buttoned, A_preview_is_buttoned_too) {
  write(k_zip, k_pinned, 4);
  BakeOptions options = scene_.options();
  options.overrides.push_back("shot.quality=preview");
  ASSERT_EQ(run(options).exit_code, 0);
  for (const double gap : gaps(4)) EXPECT_LT(gap, 2 * k_gap);  // between the buttons that are left it sags
}

TEST_F(Buttoned, A_pin_may_hold_to_a_cloth_that_comes_later_in_the_file_and_to_what_is_joined) {
  write("pins = [ { vertices = \"0-6\" } ]\nweld = 1e-4",
        "weld = 1e-4\npins = [ { within = 0.0061, to = \"vest\" }, { vertices = \"0-6\" } ]");
  BakeOptions options = scene_.options();
  options.dry_run = true;
  const std::string plan = text(run(options));
  EXPECT_NE(plan.find("49 vertices held to \"vest\", 6.0 to 6.0 mm from it"), std::string::npos) << plan;
  EXPECT_NE(plan.find("49 vertices, 72 faces, 7 pinned"), std::string::npos) << plan;
}

TEST_F(Buttoned, What_cannot_hold_is_said_before_the_first_frame) {
  expect_fault(
      "pins = [ { within = 0.001, to = \"sheet\" } ]", 2,
      "cloth \"vest\": pin within = 0.001 m selects nothing: the nearest vertex is 0.006 m from cloth \"sheet\"");
  expect_fault("pins = [ { vertices = \"0-3\", to = \"vest\" } ]", 2,
               "no other side of cloth \"vest\" is found for 4 of the 4 vertices that a pin holds to it");
  Mesh sewn = FakeScene::sheet();
  sewn.stitches.push_back({0, {8, 8}, 0, 0});
  scene_.write_garment(sewn);
  expect_fault("rest = \"mesh\"\npins = [ { vertices = \"0\", to = \"sheet\" } ]", 2, "apart until they are sewn",
               "rest = \"mesh\"");
}

}  // namespace
}  // namespace ft::test
