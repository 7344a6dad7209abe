// A finished bake of hair that swings on a ball, as the conductor would have written it: for what looks at bakes.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "baker/record/manifest.h"
#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"
#include "tests/support/combed_ball.h"
#include "tests/support/scripted_body.h"

namespace ft::test {

inline constexpr int k_combed_first = 101;
inline constexpr int k_combed_swing = 48;  ///< frames from side to side and back

/// Systems "ball", the body as drawn, and "tress", which goes on by `drift` in every frame [m].
inline void write_combed_bake(const std::filesystem::path& folder, const CombedBall& ball, int frames,
                              const Vec3& drift = Vec3::Zero()) {
  std::filesystem::create_directories(folder);
  Manifest manifest;
  manifest.version = manifest.build = manifest.fingerprint = "0";
  manifest.shot = "tress.toml";
  manifest.complete = true;
  manifest.first_frame = manifest.first_written = k_combed_first;
  manifest.last_frame = k_combed_first + frames - 1;
  CacheInfo info;
  info.first_frame = k_combed_first;
  info.frame_count = frames;

  Mesh body;
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  make_sphere(0.995 * ball.radius, 24, 32, points, triangles);
  for (Vec3& p : points) p += ball.centre;
  body = make_triangle_mesh("ball", points, triangles);
  ASSERT_TRUE(write_obj(folder / "ball.obj", body));
  info.system = "ball";
  info.mesh = body;
  auto writer = find_cache_format("pc2")->open_writer(folder / "ball.pc2", info, 0);
  ASSERT_TRUE(writer) << writer.error().text();
  for (int f = 0; f < frames; ++f) ASSERT_TRUE((*writer)->write_frame(body.positions, {}));
  ASSERT_TRUE((*writer)->close());
  ManifestSystem& drawn = manifest.systems.emplace_back();
  drawn.name = drawn.primary = "ball", drawn.role = "body", drawn.topology = "ball.obj";
  drawn.vertex_count = body.vertex_count(), drawn.face_count = body.face_count();
  drawn.caches = {{"pc2", "ball.pc2", 0, ""}};

  info.system = "tress";
  info.mesh = {};
  info.content.shape = OutputShape::k_curves;
  info.content.velocities = false;
  info.curves = combed_curves(ball);
  writer = find_cache_format("abc")->open_writer(folder / "tress.abc", info, 0);
  ASSERT_TRUE(writer) << writer.error().text();
  for (int f = 0; f < frames; ++f) {
    std::vector<Vec3> x = combed_places(ball, 2 * std::numbers::pi * f / k_combed_swing);
    for (Vec3& p : x) p += f * drift;
    ASSERT_TRUE((*writer)->write_frame(x, {}));
    FrameReport& report = manifest.frames.emplace_back();
    report.frame = k_combed_first + f;
  }
  ASSERT_TRUE((*writer)->close());
  ManifestSystem& tress = manifest.systems.emplace_back();
  tress.name = "tress", tress.role = "tress", tress.primary = "ball";
  tress.shape = OutputShape::k_curves;
  tress.count = static_cast<int>(info.curves.rest.size());
  tress.curve_count = info.curves.curve_count();
  tress.caches = {{"abc", "tress.abc", 0, ""}};
  std::ofstream(folder / "manifest.json") << to_text(manifest);
}

}  // namespace ft::test
