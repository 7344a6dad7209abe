// An independent reader: Blender shows the volumes of water in motion, and blurs them by as much as they move.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <map>

#include "io/cache/cache.h"
#include "tests/support/assets.h"

namespace ft::test {
namespace {

constexpr int k_frames = 5, k_fps = 25;
constexpr double k_voxel = 0.02;             // m
constexpr double k_along = 5, k_rising = 3;  // m/s
constexpr double k_start = -0.14;            // of the surface [m]
/// The shutter is open for half a frame.
constexpr double k_open = 0.5 / k_fps, k_tolerance = 0.15;

/// What lines "BLENDER name value" say.
std::map<std::string, std::string> output_of(const std::string& command) {
  std::map<std::string, std::string> out;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> line;
  std::string all;
  while (pipe != nullptr && std::fgets(line.data(), line.size(), pipe) != nullptr) {
    all += line.data();
    std::array<char, 64> name, value;
    if (std::sscanf(line.data(), "BLENDER %63s %63s", name.data(), value.data()) == 2) out[name.data()] = value.data();
  }
  if (pipe == nullptr || ::pclose(pipe) != 0) ADD_FAILURE() << all;
  return out;
}

CacheInfo info_of(const std::string& name) {
  CacheInfo out;
  out.system = name;
  out.fps = k_fps, out.frame_count = k_frames;
  out.content.velocities = true;
  return out;
}

/// A surface between x = 0 and x = 0.4 that rises, with foam where x is below 0.2.
void write_surface(const std::filesystem::path& path) {
  constexpr int across = 21, along = 11;
  CacheInfo info = info_of("pool");
  info.content.scalars = {"wet", "foam"};
  for (int k = 0; k < along; ++k)
    for (int i = 0; i < across; ++i) info.mesh.positions.emplace_back(0.02 * i, k_start, 0.02 * k);
  for (int k = 0; k + 1 < along; ++k)
    for (int i = 0; i + 1 < across; ++i) {
      info.mesh.face_sizes.push_back(4);
      for (const int v : {0, across, across + 1, 1}) info.mesh.face_vertices.push_back(k * across + i + v);
    }
  auto writer = find_cache_format("abc")->open_writer(path, info, 0);
  ASSERT_TRUE(writer) << writer.error().text();
  const std::vector<Vec3> v(info.mesh.positions.size(), Vec3(0, k_rising, 0));
  for (int f = 0; f < k_frames; ++f) {
    std::vector<Vec3> x = info.mesh.positions;
    for (Vec3& p : x) p += f / static_cast<double>(k_fps) * v.front();
    std::vector<std::vector<float>> scalars(2);
    for (const Vec3& p : x) scalars[0].push_back(1), scalars[1].push_back(p.x() < 0.19 ? 1.0f : 0.0f);
    const Status written = (*writer)->write_frame(x, v, scalars);
    ASSERT_TRUE(written) << written.error().text();
  }
  ASSERT_TRUE((*writer)->close());
}

/// Two clouds of droplets, 12 cm wide: one goes along, one is still.
void write_droplets(const std::filesystem::path& path) {
  CacheInfo info = info_of("pool_droplets");
  info.content = {.shape = OutputShape::k_points, .changes = true, .velocities = true, .widths = true};
  auto writer = find_cache_format("abc")->open_writer(path, info, 0);
  ASSERT_TRUE(writer) << writer.error().text();
  for (int f = 0; f < k_frames; ++f) {
    FrameData now;
    for (int n = 0; n < 2 * 12 * 12 * 12; ++n) {
      const bool moves = n % 2 == 0;
      const int k = n / 2;
      const Vec3 in_cloud = 0.01 * Vec3(k % 12 - 5.5, k / 12 % 12 - 5.5, k / 144 - 5.5), v(moves ? k_along : 0, 0, 0);
      const Vec3 middle = moves ? Vec3(-0.2, 0.6, 0) : Vec3(0.2, 1.1, 0);
      now.ids.push_back(static_cast<std::uint64_t>(n));
      now.positions.push_back((middle + in_cloud + f / static_cast<double>(k_fps) * v).cast<float>());
      now.velocities.push_back(v.cast<float>());
      now.widths.push_back(0.01f);
    }
    const Status written = (*writer)->write_frame(now.view());
    ASSERT_TRUE(written) << written.error().text();
  }
  ASSERT_TRUE((*writer)->close());
}

TEST(Blender, Blurs_the_volumes_of_water_by_as_much_as_it_moves_slow) {
  if (std::system("command -v blender > /dev/null") != 0) GTEST_SKIP() << "skipped: blender is not installed";
  const ScratchFolder scratch;
  write_surface(scratch / "pool.abc");
  write_droplets(scratch / "pool_droplets.abc");
  if (HasFatalFailure()) return;
  const auto writer = std::filesystem::path(FT_BINARY_DIR) / "bin/followthrough_write_vdb";
  const std::string folder = scratch.path().string();
  output_of(writer.string() + " " + (scratch / "pool.abc").string() + " " + (scratch / "pool_droplets.abc").string() +
            " " + folder + " pool -0.5 " + std::to_string(k_voxel));
  const auto script = std::filesystem::path(FT_SOURCE_DIR) / "tests/io_volume/blender_check.py";
  auto seen =
      output_of("blender -b --factory-startup --python-exit-code 1 --python " + script.string() + " -- " + folder +
                " pool " + std::to_string(k_frames) + " " + std::to_string(k_fps) + " " + std::to_string(k_voxel));
  EXPECT_EQ(seen["grids"], "foam+spray+surface+vel");
  EXPECT_EQ(seen["velocity"], "vel") << "it is found by its name";
  EXPECT_EQ(seen["default_unit"], "FRAME") << "`followthrough volumes` says to set another";
  ASSERT_TRUE(seen.contains("mesh_moved"));
  const auto number = [&](const char* name) { return std::stod(seen.at(name)); };
  // Where it is in the third frame; to a tenth of a voxel, which is far less than the half that Blender shifts it by.
  EXPECT_NEAR(number("still_at"), 0.2, 0.1 * k_voxel);
  EXPECT_NEAR(number("moving_at"), 0.2, 0.1 * k_voxel);
  EXPECT_NEAR(number("rising_at"), k_start + 2.0 * k_rising / k_fps, 0.1 * k_voxel);
  // Half of the foam is within three quarters of a voxel of the surface, and ends between two of its vertices.
  EXPECT_NEAR(number("foam_top"), k_start + 2.0 * k_rising / k_fps + 0.75 * k_voxel, 0.3 * k_voxel);
  EXPECT_NEAR(number("foam_bottom"), k_start + 2.0 * k_rising / k_fps - 0.75 * k_voxel, 0.3 * k_voxel);
  EXPECT_NEAR(number("foam_right"), 0.19, 0.6 * k_voxel);
  EXPECT_NEAR(number("mesh_at"), k_start + 2.0 * k_rising / k_fps, 1e-5);
  // From a frame to the next.
  EXPECT_NEAR(number("still_moved"), 0, 0.1 * k_voxel);
  EXPECT_NEAR(number("moving_moved"), 1.0 * k_along / k_fps, 0.1 * k_voxel);
  EXPECT_NEAR(number("rising_moved"), 1.0 * k_rising / k_fps, 0.1 * k_voxel);
  EXPECT_NEAR(number("mesh_moved"), 1.0 * k_rising / k_fps, 1e-5);
  // While the shutter is open.
  std::printf("streaks: %s of %g m, %s of %g m, still %s m\n", seen["moving_streak"].c_str(), k_along * k_open,
              seen["rising_streak"].c_str(), k_rising * k_open, seen["still_streak"].c_str());
  EXPECT_NEAR(number("moving_streak"), k_along * k_open, k_tolerance * k_along * k_open);
  EXPECT_NEAR(number("rising_streak"), k_rising * k_open, k_tolerance * k_rising * k_open);
  EXPECT_NEAR(number("still_streak"), 0, 0.1 * k_voxel);
}

}  // namespace
}  // namespace ft::test
