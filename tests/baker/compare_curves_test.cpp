// compare, of caches of curves that were made up so that every number is known: tests/baker/curves_bake_test.cpp has
// whole bakes.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "baker/commands/compare.h"
#include "baker/commands/compare_report.h"
#include "tests/support/assets.h"
#include "tests/support/shaped_samples.h"

namespace ft::test {
namespace {

constexpr int k_strands = 4, k_vertices = 5, k_frames = 6;

/// Straight strands of four pieces of a quarter metre each, side by side, that stand still.
ShapedSample comb() {
  ShapedSample s;
  s.name = s.info.system = "comb";
  s.info.content.shape = OutputShape::k_curves;
  s.info.content.velocities = false;
  s.info.first_frame = 1001;
  s.info.frame_count = k_frames;
  FrameData frame;
  for (int c = 0; c < k_strands; ++c) {
    s.info.curves.vertices_per_curve.push_back(k_vertices);
    s.info.curves.ids.push_back(static_cast<std::uint64_t>(40 - 10 * c));
    for (int v = 0; v < k_vertices; ++v) {
      frame.positions.emplace_back(static_cast<float>(c), -0.25f * static_cast<float>(v), 0.0f);
      s.info.curves.rest.push_back(frame.positions.back().cast<double>());
    }
  }
  s.frames.assign(k_frames, frame);
  return s;
}

Vec3f& vertex(ShapedSample& s, int frame, int strand, int v) {
  return s.frames[at(frame)].positions[at(k_vertices * strand + v)];
}

/// The same strands, the last one first.
ShapedSample reversed(const ShapedSample& s) {
  ShapedSample out = s;
  std::reverse(out.info.curves.ids.begin(), out.info.curves.ids.end());
  const auto turn = [](auto& points) {
    auto from = points;
    for (int c = 0; c < k_strands; ++c)
      for (int v = 0; v < k_vertices; ++v)
        points[at(k_vertices * c + v)] = from[at(k_vertices * (k_strands - 1 - c) + v)];
  };
  turn(out.info.curves.rest);
  for (FrameData& f : out.frames) turn(f.positions);
  return out;
}

class CompareCurves : public testing::Test {
 protected:
  CompareReport compare(const ShapedSample& a, const ShapedSample& b, double tolerance = 0) const {
    const CacheFormat& format = *find_cache_format("abc");
    EXPECT_TRUE(write_shaped(format, scratch_ / "a.abc", a, k_frames));
    EXPECT_TRUE(write_shaped(format, scratch_ / "b.abc", b, k_frames));
    const auto reports = compare_paths(scratch_ / "a.abc", scratch_ / "b.abc", tolerance);
    EXPECT_EQ(reports.size(), 1u);
    return reports.front();
  }
  ScratchFolder scratch_;
};

TEST_F(CompareCurves, Strands_are_matched_by_id_whatever_their_order) {
  const CompareReport r = compare(comb(), reversed(comb()));
  EXPECT_EQ(r.verdict, CompareVerdict::k_equal) << summary(r);
  EXPECT_EQ(r.worst, -1);
  EXPECT_TRUE(r.curves->by_id);
  EXPECT_EQ(r.curves->common, 4);
  // Without ids in one of them by index: the first is then three metres from the last.
  ShapedSample nameless = reversed(comb());
  nameless.info.curves.ids.clear();
  const CompareReport other = compare(comb(), nameless);
  EXPECT_EQ(other.verdict, CompareVerdict::k_different);
  EXPECT_FALSE(other.curves->by_id);
  EXPECT_EQ(other.frames[0].max, 3);
  EXPECT_EQ(other.curves->root_max, 3);
  EXPECT_EQ(other.element(other.frames[0].vertex), "strand 0, vertex 0");
}

TEST_F(CompareCurves, Distances_of_vertices_and_of_roots_are_those_that_were_made) {
  ShapedSample b = comb();
  vertex(b, 2, 1, 4).z() += 0.25f;   // the tip of strand 30
  vertex(b, 4, 3, 0).z() -= 0.125f;  // the root of strand 10
  const CompareReport r = compare(comb(), reversed(b), 0.0625);
  EXPECT_EQ(r.verdict, CompareVerdict::k_different);
  EXPECT_EQ(r.first_diverging, 2);
  EXPECT_EQ(r.worst, 2);
  EXPECT_EQ(r.diverging_count(), 2);
  EXPECT_EQ(r.frames[2].max, 0.25);
  EXPECT_DOUBLE_EQ(r.frames[2].rms, 0.25 / std::sqrt(20.0));
  EXPECT_EQ(r.element(r.frames[2].vertex), "strand 30, vertex 4");
  EXPECT_DOUBLE_EQ(r.rms, std::sqrt((0.0625 + 0.015625) / (6 * 20)));
  EXPECT_EQ(r.curves->p95, 0);  // two of 120
  EXPECT_EQ(r.curves->root_max, 0.125);
  EXPECT_EQ(r.curves->root_frame, 1005);
  EXPECT_EQ(r.curves->root_strand, 10u);
  const std::string lines = compare_text({r});
  for (const char* words : {"4 in both, matched by id", "roots: max 125 mm in frame 1005, strand 10", "30/4"})
    EXPECT_NE(lines.find(words), std::string::npos) << lines;
  const auto json = nlohmann::json::parse(compare_json({r}))["caches"][0];
  EXPECT_EQ(json["worst"]["strand"], nlohmann::json({{"id", 30}, {"vertex", 4}}));
  EXPECT_EQ(json["curves"]["root_strand"], 10);
  EXPECT_EQ(compare(comb(), b, 0.25).verdict, CompareVerdict::k_equal);
}

TEST_F(CompareCurves, Lengths_are_told_of_each_cache_against_its_own_rest) {
  ShapedSample b = comb();
  for (int v = 0; v < k_vertices; ++v) vertex(b, 3, 2, v).y() *= 1.5f;    // strand 20, in frame 1004
  for (int v = 0; v < k_vertices; ++v) vertex(b, 5, 0, v).y() *= 0.875f;  // strand 40, in frame 1006
  const CompareReport r = compare(comb(), b);
  const LengthRatios &of_a = r.curves->lengths_a, &of_b = r.curves->lengths_b;
  EXPECT_EQ(of_a.count, 24u);
  EXPECT_EQ(of_a.mean, 1);
  EXPECT_EQ(of_a.p99, 0);
  EXPECT_EQ(of_a.worst, 1);
  EXPECT_DOUBLE_EQ(of_b.mean, (22 + 1.5 + 0.875) / 24);
  EXPECT_DOUBLE_EQ(of_b.p99, 0.5);  // of 24 the largest
  EXPECT_DOUBLE_EQ(of_b.worst, 1.5);
  EXPECT_EQ(of_b.worst_frame, 1004);
  EXPECT_EQ(of_b.worst_strand, 20u);
  EXPECT_NE(compare_text({r}).find("lengths of b: mean 1.01562 of rest, p99 of the change 50 %, worst 1.5 in frame "
                                   "1004, strand 20"),
            std::string::npos)
      << compare_text({r});
  // Against a rest of its own that is half as long, each strand is twice its length.
  ShapedSample shorter = comb();
  for (Vec3& p : shorter.info.curves.rest) p.y() *= 0.5;
  EXPECT_DOUBLE_EQ(compare(comb(), shorter).curves->lengths_b.mean, 2);
  // A strand without a length at rest has no ratio.
  for (int v = 0; v < k_vertices; ++v) shorter.info.curves.rest[at(v)].setZero();
  EXPECT_EQ(compare(comb(), shorter).curves->lengths_b.count, 18u);
}

TEST_F(CompareCurves, Strands_that_only_one_has_or_that_have_other_vertices_are_listed) {
  ShapedSample b = comb();
  b.info.curves.ids[1] = 7;
  b.info.curves.vertices_per_curve = {k_vertices, k_vertices, k_vertices - 1, k_vertices + 1};
  const CompareReport r = compare(comb(), b, 1e3);
  EXPECT_EQ(r.verdict, CompareVerdict::k_different);
  EXPECT_EQ(r.curves->common, 3);
  EXPECT_EQ(r.curves->missing, (std::vector<std::uint64_t>{30}));
  EXPECT_EQ(r.curves->extra, (std::vector<std::uint64_t>{7}));
  EXPECT_EQ(r.curves->resized, (std::vector<std::uint64_t>{10, 20}));
  EXPECT_EQ(summary(r), "the strands are not the same ones; those that both have do not differ");
  const std::string lines = compare_text({r});
  EXPECT_NE(lines.find("3 in both, matched by id, 1 only in a (30), 1 only in b (7), 2 with another number of vertices "
                       "(10, 20)"),
            std::string::npos)
      << lines;
}

TEST_F(CompareCurves, Velocities_count_where_both_have_them) {
  ShapedSample a = comb();
  a.info.content.velocities = true;
  for (FrameData& f : a.frames) f.velocities.assign(f.positions.size(), Vec3f::Zero());
  ShapedSample b = a;
  b.frames[1].velocities[k_vertices * 2 + 3].x() = 2;
  const CompareReport r = compare(a, b, 0.01);  // 0.24 m/s at 24 fps
  EXPECT_EQ(r.verdict, CompareVerdict::k_different);
  ASSERT_EQ(r.first_diverging, 1);
  EXPECT_EQ(r.frames[1].max_speed, 2);
  EXPECT_EQ(r.element(r.frames[1].speed_vertex), "strand 20, vertex 3");
  EXPECT_EQ(compare(a, comb()).verdict, CompareVerdict::k_equal);
}

}  // namespace
}  // namespace ft::test
