// `check` of cords: their middle lines out of the tubes, against a box whose distances are known.
#include "baker/systems/cords/judge_cords.h"

#include <gtest/gtest.h>

#include <fstream>

#include "baker/core/shapes.h"
#include "baker/judge/judge_caches.h"
#include "baker/record/manifest.h"
#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"
#include "solvers/cords/generators.h"
#include "solvers/cords/tubes.h"
#include "tests/support/assets.h"
#include "tests/support/cords.h"

namespace ft::test {
namespace {

/// 1 m long, level.
CordGraph level_rope(double height, int pieces = 10) {
  RopeMeasures line;
  line.from = Vec3(-0.5, height, 0.01);
  line.to = Vec3(0.5, height, 0.01);
  line.pieces = pieces;
  return rope(line);
}

/// Cord by cord, in any order.
std::multiset<double> lengths_of(const CordGraph& graph) {
  std::multiset<double> out;
  for (const Edge& c : graph.cords) out.insert((graph.points[at(c[0])] - graph.points[at(c[1])]).norm());
  return out;
}

TEST(JudgeCords, the_middle_lines_of_a_nets_tubes_are_its_cords) {
  NetMeasures measures;
  measures.pieces = 3;
  const CordGraph net = diamond_net(measures);
  const CordTubes tubes(net, 0.003);
  const auto lines = middle_lines(tubes.mesh());
  ASSERT_TRUE(lines) << lines.error().text();
  std::vector<Vec3> points;
  append_middle_points(tubes.mesh().positions, points);
  ASSERT_EQ(std::ssize(points), lines->point_count);
  for (const Vec3& p : points) {
    double nearest = 1;
    for (const Vec3& q : net.points) nearest = std::min(nearest, (p - q).norm());
    EXPECT_LT(nearest, 1e-12);
  }
  ASSERT_EQ(lines->cords.edges.size(), net.cords.size());
  const std::multiset<double> expected = lengths_of(net);
  auto length = expected.begin();
  std::vector<double> found = lines->cords.lengths;
  std::sort(found.begin(), found.end());
  for (const double l : found) EXPECT_NEAR(l, *length++, 1e-12);
}

TEST(JudgeCords, what_is_no_tube_is_refused) {
  EXPECT_EQ(middle_lines(grid_of_quads(4, 3)).error().kind, ErrorKind::k_input);  // 20 vertices
  EXPECT_EQ(middle_lines(grid_of_quads(7, 2)).error().kind, ErrorKind::k_input);  // 24, but faces leave out rings
}

TEST(JudgeCords, the_gap_is_that_of_the_nearest_place_of_a_cord_and_not_of_its_ends) {
  const TriangleSurface box = box_surface(Vec3(0.04, 0.2, 0.2));
  const CordGraph line = level_rope(0.125, 5);  // its middle cord bridges the box
  const CordsAndBody found = judge_cords(line.cords, line.points, box.positions, box.triangles);
  EXPECT_NEAR(found.gap, 0.025, 1e-15);
  EXPECT_EQ(found.crossings, 0);
  EXPECT_EQ(found.crossed, -1);
  EXPECT_EQ(found.inside, -1);
}

TEST(JudgeCords, a_cord_through_a_body_crosses_it_twice_and_points_inside_know_their_depth) {
  const TriangleSurface box = box_surface(Vec3(0.3, 0.2, 0.2));
  const CordGraph line = level_rope(0.06);
  const CordsAndBody found = judge_cords(line.cords, line.points, box.positions, box.triangles);
  EXPECT_EQ(found.crossings, 2);
  EXPECT_EQ(found.gap, 0);
  EXPECT_GE(found.crossed, 0);
  EXPECT_GE(found.inside, 0);
  EXPECT_NEAR(found.deepest, 0.04, 1e-12);  // below the top
}

/// A bake of a rope that sinks through a box in `frames` frames, by hand.
void write_bake(const std::filesystem::path& folder, double drop_per_frame, int frames) {
  const CordGraph line = level_rope(0.15);
  const CordTubes tubes(line, 0.003, "rope");
  const TriangleSurface box = box_surface(Vec3(0.3, 0.2, 0.2));
  const Mesh body = make_triangle_mesh("box", box.positions, box.triangles);
  Manifest manifest;
  manifest.version = manifest.build = manifest.fingerprint = "0";
  manifest.complete = true;
  manifest.last_frame = frames;
  const auto write = [&](const Mesh& mesh, const std::string& name, const std::string& role, double drop) {
    ASSERT_TRUE(write_obj(folder / (name + ".obj"), mesh));
    CacheInfo info;
    info.system = name;
    info.mesh = mesh;
    info.first_frame = 1;
    info.frame_count = frames;
    auto writer = find_cache_format("abc")->open_writer(folder / (name + ".abc"), info, 0);
    ASSERT_TRUE(writer);
    std::vector<Vec3> x = mesh.positions;
    for (int f = 0; f < frames; ++f) {
      ASSERT_TRUE((*writer)->write_frame(x, {}));
      for (Vec3& p : x) p.y() -= drop;
    }
    ASSERT_TRUE((*writer)->close());
    manifest.systems.push_back(
        {name, role, "box", mesh.vertex_count(), mesh.face_count(), name + ".obj", {{"abc", name + ".abc", 0, ""}}});
  };
  write(tubes.mesh(), "rope", "cords", drop_per_frame);
  write(body, "box", "body", 0);
  std::ofstream(folder / "manifest.json") << to_text(manifest);
}

TEST(JudgeCords, a_bake_is_judged_frame_by_frame_from_its_caches) {
  const ScratchFolder folder;
  write_bake(folder.path(), 0.02, 4);  // 5, 3, 1 cm above the box, then 1 cm in it
  const auto judged = judge_caches(folder.path());
  ASSERT_TRUE(judged) << judged.error().text();
  EXPECT_TRUE(judged->notes.empty());
  ASSERT_EQ(judged->frames.size(), 4u);
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_EQ(judged->frames[f].crossings_body, 0);
    EXPECT_NEAR(judged->frames[f].smallest_gap, 0.05 - 0.02 * static_cast<double>(f), 1e-6);
    EXPECT_LT(judged->frames[f].strain_max, 1e-5);  // of single precision
    EXPECT_TRUE(judged->frames[f].incidents.empty());
  }
  const FrameReport& last = judged->frames[3];
  EXPECT_EQ(last.crossings_body, 2);
  EXPECT_NEAR(last.deepest_drawn, 0.01, 1e-6);
  ASSERT_EQ(last.incidents.size(), 2u);
  EXPECT_EQ(last.incidents[0].system, "rope");
  EXPECT_NEAR(last.incidents[0].place.y(), 0.09, 1e-6);
}

}  // namespace
}  // namespace ft::test
