// compare: verdicts and exit codes, the first frame and vertex, all four reports, and Alembic against PC2 of the same
// bake.
#include "baker/commands/compare.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "baker/commands/compare_primaries.h"
#include "baker/commands/compare_report.h"
#include "baker/core/file.h"
#include "tests/support/assets.h"
#include "tests/support/cache_samples.h"

namespace ft::test {
namespace {

class Compare : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const CacheSample& sample) {
    const auto path = scratch_ / name;
    EXPECT_TRUE(make_folders(path.parent_path()));
    const auto* format = find_cache_format(path.extension().string().substr(1));
    EXPECT_TRUE(write_cache(*format, path, sample, static_cast<int>(sample.positions.size())));
    return path;
  }
  CompareReport compare(const std::filesystem::path& a, const std::filesystem::path& b, double tolerance = 0) {
    const auto reports = compare_paths(a, b, tolerance);
    EXPECT_EQ(reports.size(), 1u);
    return reports.front();
  }
  int run(const std::filesystem::path& a, const std::filesystem::path& b, double tolerance = 0) {
    testing::internal::CaptureStdout();
    const int code = run_compare({a, b, tolerance, scratch_ / "r.json", scratch_ / "r.html", scratch_ / "r.xml"});
    text_ = testing::internal::GetCapturedStdout();
    return code;
  }
  std::string read(const std::string& name) { return read_text(scratch_ / name).value(); }

  ScratchFolder scratch_;
  std::string text_;
  const CacheSample sample_ = waving_patch(4, 3, 6);
};

CacheSample moved(CacheSample sample, std::size_t frame, std::size_t vertex, double by) {
  sample.positions[frame][vertex].z() += by;
  return sample;
}

TEST_F(Compare, Equal_caches_do_not_differ_at_all) {
  for (const std::string extension : {".abc", ".pc2"}) {
    const auto a = write("a" + extension, sample_), b = write("b" + extension, sample_);
    const CompareReport r = compare(a, b);
    EXPECT_EQ(r.verdict, CompareVerdict::k_equal);
    EXPECT_EQ(r.worst, -1);
    EXPECT_EQ(r.rms, 0);
    ASSERT_EQ(r.frames.size(), 6u);
    for (const FrameDifference& f : r.frames) EXPECT_TRUE(f.max == 0 && f.rms == 0 && f.vertex == -1);
    EXPECT_EQ(run(a, b), 0);
  }
}

TEST_F(Compare, Alembic_and_pc2_of_one_bake_are_bit_equal) {
  CacheSample irrational = sample_;
  for (auto& frame : irrational.positions)
    for (Vec3& p : frame) p = p / 3.0 + Vec3(0.1, 1e-7, 100.7);
  EXPECT_EQ(run(write("x.abc", irrational), write("x.pc2", irrational)), 0);
  EXPECT_NE(text_.find("no difference at all"), std::string::npos) << text_;
}

TEST_F(Compare, The_first_diverging_frame_and_vertex_are_named) {
  const CacheSample changed = moved(moved(sample_, 2, 7, 0.25), 4, 11, -0.5);
  const auto a = write("a.abc", sample_), b = write("b.pc2", changed);
  const CompareReport r = compare(a, b, 0.125);
  EXPECT_EQ(r.verdict, CompareVerdict::k_different);
  ASSERT_EQ(r.first_diverging, 2);
  EXPECT_EQ(r.frames[2].frame, 1003);
  EXPECT_EQ(r.frames[2].vertex, 7);
  EXPECT_EQ(r.frames[2].max, 0.25);
  EXPECT_DOUBLE_EQ(r.frames[2].rms, 0.25 / std::sqrt(20.0));
  EXPECT_EQ(r.worst, 4);
  EXPECT_EQ(r.frames[4].vertex, 11);
  EXPECT_EQ(r.diverging_count(), 2);
  EXPECT_DOUBLE_EQ(r.rms, std::sqrt((0.0625 + 0.25) / (6 * 20)));
  EXPECT_EQ(r.picture_distances[11], 0.5f);
  EXPECT_EQ(run(a, b, 0.125), 1);
  EXPECT_NE(text_.find("in frame 1003, vertex 7 (250 mm)"), std::string::npos) << text_;
}

TEST_F(Compare, A_difference_as_large_as_the_tolerance_is_equal_and_one_float_more_is_not) {
  const auto a = write("a.pc2", sample_);
  const auto b = write("b.pc2", moved(sample_, 1, 0, 0.25));
  EXPECT_EQ(run(a, b, 0.25), 0);
  EXPECT_EQ(run(a, b, std::nextafter(0.25, 0.0)), 1);
  EXPECT_EQ(run(a, b, 0), 1);
  EXPECT_EQ(run(a, b, -1), 2);
  EXPECT_EQ(run(a, b, std::nan("")), 2);
}

TEST_F(Compare, Velocities_count_where_both_caches_have_them) {
  CacheSample changed = sample_;
  changed.velocities[3][5].x() += 1;
  const auto a = write("a.abc", sample_), b = write("b.abc", changed);
  const CompareReport r = compare(a, b, 0.01);  // 0.24 m/s at 24 fps
  EXPECT_EQ(r.verdict, CompareVerdict::k_different);
  ASSERT_EQ(r.first_diverging, 3);
  EXPECT_EQ(r.frames[3].speed_vertex, 5);
  EXPECT_EQ(r.frames[3].max_speed, 1);
  EXPECT_EQ(run(a, b, 0.05), 0);
  EXPECT_EQ(run(a, write("c.pc2", changed), 0), 0);
}

TEST_F(Compare, Another_topology_range_or_rate_cannot_be_compared) {
  const auto a = write("a.abc", sample_);
  CacheSample other = sample_;
  std::reverse(other.info.mesh.face_vertices.begin(), other.info.mesh.face_vertices.begin() + 4);
  EXPECT_EQ(run(a, write("faces.abc", other)), 3);
  EXPECT_EQ(run(a, write("faces.pc2", other)), 0);
  other = sample_;
  other.info.first_frame = 1002;
  for (const char* name : {"start.abc", "start.pc2"}) {
    EXPECT_EQ(run(a, write(name, other)), 3);
    EXPECT_NE(text_.find("frames 1001-1006 against frames 1002-1007"), std::string::npos) << text_;
  }
  other = sample_;
  other.info.fps = 25;
  EXPECT_EQ(run(a, write("rate.abc", other)), 3);
  EXPECT_EQ(run(a, write("short.abc", waving_patch(4, 3, 5))), 3);
  EXPECT_EQ(run(a, write("small.pc2", waving_patch(3, 3, 6))), 3);
  EXPECT_NE(text_.find("20 vertices against 16"), std::string::npos) << text_;
}

TEST_F(Compare, What_cannot_be_read_cannot_be_compared) {
  const auto a = write("a.abc", sample_);
  EXPECT_EQ(run(a, scratch_ / "missing.abc"), 3);
  EXPECT_EQ(run(a, scratch_.path()), 3);
  ASSERT_TRUE(write_text_durably(scratch_ / "text.abc", "no cache"));
  EXPECT_EQ(run(scratch_ / "text.abc", a), 3);
  ASSERT_TRUE(make_folders(scratch_ / "empty1"));
  ASSERT_TRUE(make_folders(scratch_ / "empty2"));
  EXPECT_EQ(run(scratch_ / "empty1", scratch_ / "empty2"), 3);
}

TEST_F(Compare, A_report_that_cannot_be_written_is_an_output_error) {
  const auto a = write("a.pc2", sample_);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_compare({a, a, 0, scratch_ / "none/r.json", {}, {}}), 6);
  testing::internal::GetCapturedStdout();
  EXPECT_NE(testing::internal::GetCapturedStderr().find("none/r.json"), std::string::npos);
}

TEST_F(Compare, Folders_are_compared_by_matching_names) {
  write("a/dress.abc", sample_), write("a/dress.pc2", sample_), write("a/hat.pc2", sample_);
  write("b/dress.abc", sample_), write("b/dress.pc2", moved(sample_, 5, 1, 1)), write("b/hat.abc", sample_);
  EXPECT_EQ(run(scratch_ / "a", scratch_ / "b"), 1);
  const auto reports = compare_paths(scratch_ / "a", scratch_ / "b", 0);
  ASSERT_EQ(reports.size(), 3u);
  EXPECT_EQ(reports[0].verdict, CompareVerdict::k_equal);
  EXPECT_EQ(reports[1].verdict, CompareVerdict::k_different);
  EXPECT_EQ(reports[2].system, "hat");
  EXPECT_EQ(reports[2].verdict, CompareVerdict::k_equal);
  write("b/cape.abc", sample_);
  EXPECT_EQ(run(scratch_ / "a", scratch_ / "b"), 3);
  EXPECT_EQ(run(scratch_ / "b", scratch_ / "a"), 3);
  EXPECT_NE(text_.find("cape: incomparable: no cache of this name"), std::string::npos) << text_;
}

TEST_F(Compare, Reports_say_the_same_as_the_exit_code) {
  const auto a = write("a & <b>.abc", sample_), b = write("b.abc", moved(sample_, 2, 7, 0.25));
  ASSERT_EQ(run(a, b), 1);
  const auto json = nlohmann::json::parse(read("r.json"));
  EXPECT_EQ(json["exit_code"], 1);
  EXPECT_EQ(json["verdict"], "different");
  const auto& cache = json["caches"][0];
  EXPECT_EQ(cache["first_diverging"]["frame"], 1003);
  EXPECT_EQ(cache["first_diverging"]["vertex"], 7);
  EXPECT_EQ(cache["worst"]["max"], 0.25);
  EXPECT_EQ(cache["frames"].size(), 6u);
  const std::string html = read("r.html"), xml = read("r.xml");
  for (const char* part : {"<polyline", "<circle", "different", "a &amp; &lt;b&gt;", "vertex 7"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  for (const char* outside : {"http", "src=", "<script", "<b>.abc"})
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  EXPECT_NE(xml.find("failures=\"1\" errors=\"0\""), std::string::npos) << xml;
  ASSERT_EQ(run(a, a), 0);
  EXPECT_NE(read("r.xml").find("failures=\"0\" errors=\"0\""), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(read("r.json"))["exit_code"], 0);
  ASSERT_EQ(run(a, scratch_ / "missing.abc"), 3);
  EXPECT_NE(read("r.xml").find("failures=\"0\" errors=\"1\""), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(read("r.json"))["verdict"], "incomparable");
}

TEST_F(Compare, Large_pictures_are_thinned_and_keep_the_worst_vertex) {
  const CacheSample big = waving_patch(150, 100, 1);
  ASSERT_EQ(run(write("a.pc2", big), write("b.pc2", moved(big, 0, 9000, 2))), 1);
  const std::string html = read("r.html");
  EXPECT_LT(html.size(), 2u << 20);
  EXPECT_NE(html.find("worst (vertex 9000) is circled"), std::string::npos);
}

TEST_F(Compare, Paths_of_primaries_differ_by_so_much_at_that_frame_and_end_at_those_velocities) {
  const double g = 9.81, fps = 50;
  PrimaryPath thrown{"ball", {}}, kept{"ball", {}};
  for (int f = 0; f < 21; ++f) {
    const double t = f / fps;
    thrown.centres.emplace_back(2 * t, 1 * t - 0.5 * g * t * t, 0);
    kept.centres.push_back(thrown.centres.back() + (f == 7 ? Vec3(0, 0, 0.25) : Vec3(0, 0, 0.01 * t)));
  }
  kept.centres.erase(kept.centres.begin(), kept.centres.begin() + 3);  // its bake begins later
  Manifest a, b;
  a.fps = b.fps = fps;
  a.first_written = 1001, b.first_written = 1004;
  const auto rows = compare_primaries({thrown, {"hand", {Vec3::Zero()}}}, a, {kept}, b);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].frame, 1008);
  EXPECT_DOUBLE_EQ(rows[0].largest, 0.25);
  const Vec3 end(2, 1 - g * 20 / fps, 0);  // differences of second order are exact in free flight
  EXPECT_LT((rows[0].velocity_a - end).norm(), 1e-12);
  EXPECT_LT((rows[0].velocity_b - end - Vec3(0, 0, 0.01)).norm(), 1e-12);
  EXPECT_NE(to_text(rows).find("primary \"ball\": paths differ by up to 0.25 m, at frame 1008"), std::string::npos);
  EXPECT_EQ(to_text(compare_primaries({kept}, b, {kept}, b)), "primary \"ball\": the same path in both\n");
}

TEST_F(Compare, Caches_without_frames_are_equal) {
  const CacheSample none = waving_patch(2, 2, 0);
  EXPECT_EQ(run(write("a.abc", none), write("b.pc2", none)), 0);
}

}  // namespace
}  // namespace ft::test
