// Velocities in caches: central differences of the positions in the file, wherever both neighbours are known.
#include <gtest/gtest.h>

#include <csignal>

#include "io/cache/cache.h"
#include "tests/baker/fake_bake.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr double k_fps = 24;

struct Frames {
  std::vector<std::vector<Vec3f>> x, v;
};

Frames frames_of(const std::filesystem::path& file) {
  Frames out;
  auto cache = open_cache(file);
  if (!cache) {
    ADD_FAILURE() << cache.error().text();
    return out;
  }
  EXPECT_TRUE((*cache)->info().has_velocity);
  for (int i = 0; i < (*cache)->info().frame_count; ++i) {
    EXPECT_TRUE((*cache)->read_frame(i, out.x.emplace_back()).ok());
    EXPECT_TRUE((*cache)->read_velocities(i, out.v.emplace_back()).ok());
  }
  return out;
}

/// Of the difference of the frames a and b, b that so much back [m], to the velocity at frame `at` [m/s].
double off(const Frames& frames, std::size_t at, std::size_t a, std::size_t b, const Vec3& back = Vec3::Zero()) {
  double out = 0;
  for (std::size_t k = 0; k < frames.x[at].size(); ++k) {
    const Vec3 way = frames.x[b][k].cast<double>() - back - frames.x[a][k].cast<double>();
    out = std::max(out, (way * k_fps / static_cast<double>(b - a) - frames.v[at][k].cast<double>()).norm());
  }
  return out;
}

constexpr double k_rounding = 1e-5;  // of 3 m and 24 frames a second as 32-bit numbers: 3 * 24 * 6e-8

TEST(Velocities, are_central_and_one_sided_in_the_last_frame) {
  test::FakeScene scene;
  ASSERT_EQ(scene.run().exit_code, 0);
  const Frames frames = frames_of(scene.folder().path / "sheet.abc");
  ASSERT_EQ(frames.x.size(), 10u);
  double backward = 0;
  for (std::size_t f = 1; f + 1 < 10; ++f) {
    EXPECT_LT(off(frames, f, f - 1, f + 1), k_rounding) << f;
    backward = std::max(backward, off(frames, f, f - 1, f));
  }
  EXPECT_GT(backward, 1e-3) << "the motion is uniform, and every difference the same";
  EXPECT_LT(off(frames, 9, 8, 9), k_rounding);
  EXPECT_GT(off(frames, 0, 0, 1), 1e-3) << "the pre-roll knows the frame before the first";
}

TEST(Velocities, of_the_first_frame_are_one_sided_without_a_frame_before_it) {
  test::FakeScene scene;
  BakeOptions options = scene.options();
  options.overrides = {"shot.write_preroll=true"};
  ASSERT_EQ(scene.run(options).exit_code, 0);
  const Frames frames = frames_of(scene.folder().path / "sheet.abc");
  ASSERT_EQ(frames.x.size(), 13u);
  EXPECT_LT(off(frames, 0, 0, 1), k_rounding);
  for (std::size_t f = 1; f + 1 < 13; ++f) EXPECT_LT(off(frames, f, f - 1, f + 1), k_rounding) << f;
}

TEST(Velocities, of_a_single_frame_are_zero) {
  test::FakeScene scene;
  scene.write_shot(1);
  BakeOptions options = scene.options();
  options.overrides = {"shot.preroll=0"};
  ASSERT_EQ(scene.run(options).exit_code, 0);
  const Frames frames = frames_of(scene.folder().path / "sheet.abc");
  ASSERT_EQ(frames.v.size(), 1u);
  for (const Vec3f& v : frames.v[0]) EXPECT_EQ(v, Vec3f(Vec3f::Zero()));
}

/// A box that is 3 m further on from frame 7.
std::unique_ptr<Trajectory> jumping_box(const Trajectory& box, const ImportRequest& request) {
  std::vector<Vec3> bind(8);
  box.bind_pose(bind);
  return std::make_unique<ScriptedBody>(box.surface(), bind, box.preroll(),
                                        [fps = request.shot_fps](double time, std::span<Vec3> x) {
                                          if (time * fps > 5.5)
                                            for (Vec3& p : x) p.x() += 3;
                                        });
}

TEST(Velocities, do_not_see_the_way_of_a_jump) {
  test::FakeScene scene;
  ASSERT_EQ(scene.run(scene.options(), {.move = jumping_box}).exit_code, 0);
  const Frames frames = frames_of(scene.folder().path / "sheet.abc");
  const Vec3 jump(3, 0, 0);  // into frame 7, which has index 6
  for (std::size_t f = 1; f + 1 < 10; ++f)
    EXPECT_LT(off(frames, f, f - 1, f + 1, f == 5 || f == 6 ? jump : Vec3::Zero()), k_rounding) << f;
}

TEST(Velocities, of_an_interrupted_bake_end_one_sided_and_a_resume_makes_them_central) {
  test::FakeScene scene;
  test::RecordedProgress progress;
  progress.on_frame = [&](int f) { f == 4 ? void(std::raise(SIGINT)) : void(); };
  ASSERT_EQ(bake(scene.options(), scene.services(), progress).exit_code, 130);
  const Frames part = frames_of(scene.folder().path / "sheet.abc");
  ASSERT_EQ(part.x.size(), 4u);
  EXPECT_LT(off(part, 3, 2, 3), k_rounding);
  EXPECT_LT(off(part, 2, 1, 3), k_rounding);
  BakeOptions options = scene.options();
  options.resume = true;
  ASSERT_EQ(scene.run(options).exit_code, 0);
  const Frames whole = frames_of(scene.folder().path / "sheet.abc");
  EXPECT_LT(off(whole, 3, 2, 4), k_rounding);
}

}  // namespace
}  // namespace ft
