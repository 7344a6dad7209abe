// A real cache of another program: the dancing mannequin of Codimensional IPC, 121 frames of 12,811 vertices.
#include <gtest/gtest.h>

#include "tests/support/assets.h"
#include "tests/support/cache_samples.h"

namespace ft::test {
namespace {

TEST(RealCache, A_pc2_of_another_program_goes_through_every_format_unchanged) {
  const auto path = assets_root() / "garments/cipc_mannequin_rumba/rumba_body_121f.pc2";
  FT_REQUIRE_FILE(path);
  auto source = open_cache(path);
  ASSERT_TRUE(source) << source.error().text();
  ASSERT_EQ((*source)->info().frame_count, 121);
  ASSERT_EQ((*source)->info().vertex_count, 12811);
  CacheInfo info = (*source)->info();
  info.mesh.face_sizes = {3};
  info.mesh.face_vertices = {0, 1, 12810};
  info.frame_count = 12;
  ScratchFolder scratch;
  for (const CacheFormat& format : cache_formats()) {
    const auto copy = scratch / ("copy" + std::string(format.extension));
    std::vector<Vec3f> wanted, found;
    auto writer = format.open_writer(copy, info, 0);
    ASSERT_TRUE(writer);
    for (int f = 0; f < 12; ++f) {
      ASSERT_TRUE((*source)->read_frame(10 * f, wanted));
      std::vector<Vec3> positions;
      for (const Vec3f& p : wanted) positions.push_back(p.cast<double>());
      ASSERT_TRUE((*writer)->write_frame(positions, {}));
    }
    ASSERT_TRUE((*writer)->close());
    auto reader = open_cache(copy);
    ASSERT_TRUE(reader);
    for (int f = 0; f < 12; ++f) {
      ASSERT_TRUE((*source)->read_frame(10 * f, wanted));
      ASSERT_TRUE((*reader)->read_frame(f, found));
      ASSERT_EQ(wanted, found);
    }
  }
}

}  // namespace
}  // namespace ft::test
