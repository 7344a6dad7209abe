// Damaged files: a cut one is refused wherever it is cut; whatever else happens to one, there is a finite result or an
// error that names the file. Each try is a process.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "baker/core/file.h"
#include "io/volume/vdb_read.h"
#include "tests/io_volume/openvdb_sample.h"
#include "tests/support/assets.h"
#include "tests/support/damage.h"
#include "tests/support/sanitized.h"

namespace ft {
namespace {

Bytes good_file(const std::filesystem::path& path, bool seekable) {
  test::SampleGrid grid;
  grid.field = [](const Vec3& p) { return p; };
  test::write_vdb(path, {.grids = {grid}, .seekable = seekable});
  auto bytes = read_file(path);
  EXPECT_TRUE(bytes);
  return std::move(*bytes);
}

struct Tally {
  int read = 0, refused = 0, crashed = 0;
};

void try_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes, Tally& tally) {
  ASSERT_TRUE(write_file_durably(path, bytes));
  VdbOptions options;
  options.limits.seconds = 5;
  const auto got = read_vdb_velocity(path, {}, options);
  ++(got ? tally.read : tally.refused);
  if (got) {
    const bool finite =
        std::all_of(got->velocities.begin(), got->velocities.end(), [](auto& v) { return v.allFinite(); });
    EXPECT_TRUE(finite && got->to_world.matrix().allFinite());
    return;
  }
  EXPECT_EQ(got.error().where, path.string());
  EXPECT_EQ(got.error().what.find("ended with code"), std::string::npos) << got.error().text();
  if (got.error().what.find("crashed") != std::string::npos) ++tally.crashed;
}

void cut_and_flip(std::size_t cut_step, std::size_t flip_step) {
  const test::ScratchFolder scratch(test::ScratchFolder::k_in_memory);
  for (const bool seekable : {true, false}) {
    const auto path = scratch / "air.vdb";
    Bytes bytes = good_file(path, seekable);
    Tally cuts, flips;
    for (std::size_t size = 0; size < bytes.size(); size += cut_step)
      try_bytes(path, std::span(bytes).first(size), cuts);
    try_bytes(path, std::span(bytes).first(bytes.size() - 1), cuts);
    EXPECT_EQ(cuts.read, 0);
    EXPECT_EQ(cuts.crashed, 0);
    for (std::size_t at = 0; at < bytes.size(); at += flip_step) {
      const auto flip = at % 3 == 0 ? std::byte{0xff} : static_cast<std::byte>(1u << at % 8);
      bytes[at] ^= flip;
      try_bytes(path, bytes, flips);
      bytes[at] ^= flip;
    }
    EXPECT_GT(flips.read, 0) << "damage that no file survives tests little";
    std::printf("  %zu bytes; flipped: %d read, %d refused, of which crashed in the child: %d\n", bytes.size(),
                flips.read, flips.refused, flips.crashed);
  }
}

TEST(Vdb_damage, Cut_files_are_refused_and_flipped_bytes_never_crash) {
  cut_and_flip(1511, 997);
}

TEST(Vdb_damage, Files_that_are_cut_anywhere_or_flipped_anywhere_slow) {
  const std::size_t step = test::every(5, "damages");
  cut_and_flip(41 * step, 23 * step);
}

TEST(Vdb_damage, What_is_no_vdb_is_refused) {
  const test::ScratchFolder scratch;
  const auto path = scratch / "air.vdb";
  for (const std::string text : {"", "x", "something else that is longer than any head of a file would have to be"}) {
    ASSERT_TRUE(write_text_durably(path, text));
    const auto got = read_vdb_velocity(path);
    ASSERT_FALSE(got);
    EXPECT_NE(got.error().what.find("no OpenVDB file"), std::string::npos) << got.error().text();
  }
  EXPECT_FALSE(read_vdb_velocity(scratch / "missing.vdb"));
  EXPECT_FALSE(read_vdb_velocity(scratch.path()));
}

}  // namespace
}  // namespace ft
