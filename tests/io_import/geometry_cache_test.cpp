// Geometry caches as primaries: PC2, MDD, OBJ sequences; exact at the samples, smooth between, and refused when cut.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdio>

#include "baker/core/file.h"
#include "io/cache/cache.h"
#include "io/import/files/read_geometry_cache.h"
#include "io/import/import.h"
#include "io/import/motion/sampled_trajectory.h"
#include "io/shot/mesh_file.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

constexpr const char* k_tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

/// Vertex v of sample s: a cubic in time would not be reproduced by Catmull-Rom, a parabola is (inside).
Vec3f place(int s, int v) {
  return {static_cast<float>(v + 0.25 * s * s), static_cast<float>(2 * v + s), static_cast<float>(v == 3)};
}

Bytes make_pc2(int points, int samples) {
  ByteWriter out;
  out.write_raw("POINTCACHE2", 12)
      .write(std::int32_t{1})
      .write(std::int32_t{points})
      .write(1001.0f)
      .write(1.0f)
      .write(std::int32_t{samples});
  for (int s = 0; s < samples; ++s)
    for (int v = 0; v < points; ++v) {
      const Vec3f p = place(s, v);
      out.write(p.x()).write(p.y()).write(p.z());
    }
  return out.take();
}

Bytes make_mdd(int points, int samples, float step) {
  ByteWriter out;
  const auto big = [&](std::uint32_t v) {
    out.write(static_cast<std::uint32_t>(v >> 24 | (v >> 8 & 0xff00u) | (v << 8 & 0xff0000u) | v << 24));
  };
  big(static_cast<std::uint32_t>(samples)), big(static_cast<std::uint32_t>(points));
  for (int s = 0; s < samples; ++s) big(std::bit_cast<std::uint32_t>(step * static_cast<float>(s)));
  for (int s = 0; s < samples; ++s)
    for (int v = 0; v < points; ++v)
      for (int k = 0; k < 3; ++k) big(std::bit_cast<std::uint32_t>(place(s, v)[k]));
  return out.take();
}

void expect_motion(const ImportRequest& request) {
  auto primary = import_primary(request);
  ASSERT_TRUE(primary) << primary.error().text();
  const Trajectory& t = *primary->trajectory;
  ASSERT_EQ(t.surface().vertex_count(), 4);
  EXPECT_EQ(t.surface().triangles.size(), 4u);
  EXPECT_EQ(t.surface().parts.size(), 1u);
  std::vector<Vec3> p(4);
  for (int s = 0; s < 5; ++s) {
    t.sample(s / 10.0, p);
    for (int v = 0; v < 4; ++v)
      EXPECT_LT((p[static_cast<std::size_t>(v)] - place(s, v).cast<double>()).norm(), 1e-6) << s;
  }
  t.sample(0.25, p);  // between samples 2 and 3 the parabola is exact
  EXPECT_NEAR(p[1].x(), 1 + 0.25 * 2.5 * 2.5, 1e-6);
  t.sample(-3, p);  // before the shot: the first sample, set back by the run-up, which ends with 10 m/s in y
  const Vec3 back = p[0] - place(0, 0).cast<double>();
  EXPECT_NEAR(back.y(), -0.5 * 0.4 * request.preroll * 10, 1e-5);
  EXPECT_LT((back - t.bind_to_start().translation()).norm(), 1e-12);
  for (int v = 1; v < 4; ++v)
    EXPECT_LT((p[static_cast<std::size_t>(v)] - place(0, v).cast<double>() - back).norm(), 1e-12) << v;
  t.sample(99, p);
  EXPECT_LT((p[2] - place(4, 2).cast<double>()).norm(), 1e-6) << "held after the end";
}

/// As a bake leaves it, at 10 fps.
void write_alembic(const std::filesystem::path& file, const std::filesystem::path& topology) {
  CacheInfo info;
  info.system = "body";
  info.mesh = *read_obj(topology);
  info.fps = 10;
  info.frame_count = 5;
  auto writer = find_cache_format("abc")->open_writer(file, info, 0);
  ASSERT_TRUE(writer) << writer.error().text();
  for (int s = 0; s < 5; ++s) {
    std::vector<Vec3> x;
    for (int v = 0; v < 4; ++v) x.push_back(place(s, v).cast<double>());
    ASSERT_TRUE((*writer)->write_frame(x, {}));
  }
  ASSERT_TRUE((*writer)->close());
}

TEST(Geometry_cache, Pc2_mdd_alembic_and_obj_sequences_move_alike) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text_durably(scratch / "body.obj", k_tetrahedron));
  ASSERT_TRUE(write_file_durably(scratch / "body.pc2", make_pc2(4, 5)));
  ASSERT_TRUE(write_file_durably(scratch / "body.mdd", make_mdd(4, 5, 0.1f)));
  for (int s = 0; s < 5; ++s) {
    std::string text;
    for (int v = 0; v < 4; ++v) {
      char line[120];
      const Vec3f p = place(s, v);
      std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", static_cast<double>(p.x()), static_cast<double>(p.y()),
                    static_cast<double>(p.z()));
      text += line;
    }
    ASSERT_TRUE(write_text_durably(scratch / ("step_" + std::to_string(98 + s) + ".obj"),
                                   text + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"));
  }
  ImportRequest request;
  request.unit_scale = 1, request.source_fps = 10;
  request.file = scratch / "body.pc2", request.topology = scratch / "body.obj";
  expect_motion(request);
  request.preroll = 0;
  expect_motion(request);
  request.preroll = 1;
  request.file = scratch / "body.mdd";
  expect_motion(request);
  request.source_fps = 0;  // an MDD has times of its own
  expect_motion(request);
  request.topology.clear();
  write_alembic(scratch / "body.abc", scratch / "body.obj");
  request.file = scratch / "body.abc";  // so has Alembic, and faces
  expect_motion(request);
  request.source_fps = 10;
  expect_motion(request);
  request.file = scratch / "step_100.obj";  // 98, 99, 100: by number, not by letter
  expect_motion(request);
  request.file = scratch / "step_####.obj";
  expect_motion(request);
  std::filesystem::remove(scratch / "step_99.obj");
  auto gap = import_primary(request);
  ASSERT_FALSE(gap);
  EXPECT_NE(gap.error().text().find("number 99 is missing"), std::string::npos) << gap.error().text();
}

TEST(Geometry_cache, Cut_at_any_byte_is_refused) {
  const test::ScratchFolder scratch;
  for (const auto& [name, bytes] :
       {std::pair<const char*, Bytes>{"a.pc2", make_pc2(4, 3)}, {"a.mdd", make_mdd(4, 3, 0.1f)}}) {
    ASSERT_TRUE(write_file_durably(scratch / name, bytes));
    ASSERT_TRUE(read_geometry_cache(scratch / name, {}, 24, false));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      std::filesystem::resize_file(scratch / name, bytes.size() - 1 - size);
      const auto cut = read_geometry_cache(scratch / name, {}, 24, false);
      ASSERT_FALSE(cut) << name << " at " << size;
      EXPECT_NE(cut.error().text().find(name), std::string::npos);
    }
  }
}

TEST(Geometry_cache, Lies_and_numbers_that_are_not_finite_are_refused) {
  const test::ScratchFolder scratch;
  const auto refused = [&](auto change) {
    Bytes bytes = make_pc2(4, 3);
    change(bytes);
    EXPECT_TRUE(write_file_durably(scratch / "a.pc2", bytes));
    return !read_geometry_cache(scratch / "a.pc2", {}, 24, false);
  };
  const auto put = [](Bytes& b, std::size_t at, auto value) { std::memcpy(b.data() + at, &value, sizeof value); };
  EXPECT_FALSE(refused([](Bytes&) {}));
  EXPECT_TRUE(refused([&](Bytes& b) { put(b, 12, std::int32_t{2}); }));
  for (const int points : {0, -1, 5, 2147483647, -2147483647})
    EXPECT_TRUE(refused([&](Bytes& b) { put(b, 16, std::int32_t{points}); })) << points;
  for (const int samples : {0, -1, 4, 2147483647})
    EXPECT_TRUE(refused([&](Bytes& b) { put(b, 28, std::int32_t{samples}); })) << samples;
  for (const float bad : {std::nanf(""), 1 / 0.0f, 2e9f})
    EXPECT_TRUE(refused([&](Bytes& b) { put(b, 32 + 12 * 5 + 4, bad); }));
  EXPECT_TRUE(refused([&](Bytes& b) { put(b, 24, std::nanf("")); }));
}

TEST(Geometry_cache, Without_faces_asks_for_a_topology_and_checks_it) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_file_durably(scratch / "a.pc2", make_pc2(5, 3)));
  ASSERT_TRUE(write_text_durably(scratch / "body.obj", k_tetrahedron));
  ImportRequest request;
  request.file = scratch / "a.pc2", request.unit_scale = 1;
  auto bare = import_primary(request);
  ASSERT_FALSE(bare);
  EXPECT_NE(bare.error().text().find("topology ="), std::string::npos) << bare.error().text();
  request.topology = scratch / "body.obj";
  auto other = import_primary(request);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().text().find("has 4 vertices, a.pc2 has 5"), std::string::npos) << other.error().text();
}

TEST(Geometry_cache, The_rumba_mannequin_dances_in_metres) {
  const auto folder = test::assets_root() / "garments/cipc_mannequin_rumba";
  FT_REQUIRE_FILE(folder / "rumba_body_121f.pc2");
  ImportRequest request;
  request.file = folder / "rumba_body_121f.pc2", request.topology = folder / "body_frame0_yup.obj";
  request.source_fps = 25, request.shot_fps = 24, request.duration = 4.8;
  auto primary = import_primary(request);
  ASSERT_TRUE(primary) << primary.error().text();
  const Trajectory& t = *primary->trajectory;
  EXPECT_EQ(t.surface().vertex_count(), 12811);
  EXPECT_EQ(t.surface().triangles.size(), 25472u);
  std::vector<Vec3> a(12811), b(12811);
  t.sample(0, a);
  EXPECT_NEAR(bounds(a).size().y(), 1.50, 0.02);
  EXPECT_NEAR(bounds(a).lo.y(), 0, 0.01);
  double fastest = 0;
  for (int f = 1; f <= 120; ++f) {
    t.sample(f / 25.0, b);
    for (std::size_t i = 0; i < a.size(); ++i) fastest = std::max(fastest, (a[i] - b[i]).norm() * 25);
    a.swap(b);
  }
  EXPECT_NEAR(fastest, 2.07, 0.01);
  request.duration = 5;
  EXPECT_EQ(exit_code(import_primary(request).error().kind), 2) << "121 samples are 4.8 s";
}

TEST(Pieces, Are_what_triangles_join) {
  int count = 0;
  const std::vector<Triangle> triangles{{0, 1, 2}, {5, 4, 6}, {2, 1, 3}};
  EXPECT_EQ(connected_pieces(8, triangles, count), (std::vector<int>{0, 0, 0, 0, 1, 1, 1, 0}));
  EXPECT_EQ(count, 2);
}

}  // namespace
}  // namespace ft
