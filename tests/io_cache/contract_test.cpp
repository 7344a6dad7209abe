// What every cache format promises, run over the list of formats: what is written is read, after every frame, after
// every resume; what is cut, flipped or lying is refused or read without harm.
#include <gtest/gtest.h>

#include "baker/core/file.h"
#include "tests/support/assets.h"
#include "tests/support/cache_samples.h"

namespace ft::test {
namespace {

class CacheFormats : public testing::TestWithParam<CacheFormat> {
 protected:
  std::filesystem::path path(const std::string& name = "cache") const {
    return scratch_ / (name + std::string(GetParam().extension));
  }
  Bytes bytes_of(const std::filesystem::path& p) const {
    auto data = read_file(p);
    EXPECT_TRUE(data) << p;
    return data ? std::move(*data) : Bytes{};
  }
  void put(const Bytes& bytes, const std::filesystem::path& p) const { ASSERT_TRUE(write_file_durably(p, bytes)); }
  ScratchFolder scratch_{ScratchFolder::k_in_memory};
};

void expect_same_points(const std::vector<Vec3>& wanted, const std::vector<Vec3f>& found) {
  ASSERT_EQ(wanted.size(), found.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) ASSERT_EQ(wanted[i].cast<float>(), found[i]) << "vertex " << i;
}

/// The first frame_count frames of the sample are there, exactly, and nothing else.
void expect_holds(const CacheSample& sample, int frame_count, const std::filesystem::path& path) {
  auto reader = open_cache(path);
  ASSERT_TRUE(reader) << reader.error().text();
  const CacheInfo& info = (*reader)->info();
  ASSERT_EQ(info.frame_count, frame_count);
  EXPECT_EQ(info.first_frame, sample.info.first_frame);
  EXPECT_EQ(info.vertex_count, sample.info.mesh.vertex_count());
  if (info.has_fps) {
    EXPECT_EQ(info.fps, sample.info.fps);
  }
  if (info.has_topology) {
    EXPECT_EQ(info.system, sample.info.system);
    EXPECT_EQ(info.metadata, sample.info.metadata);
    EXPECT_EQ(info.mesh.face_sizes, sample.info.mesh.face_sizes);
    EXPECT_EQ(info.mesh.face_vertices, sample.info.mesh.face_vertices);
    EXPECT_EQ(info.mesh.uvs, sample.info.mesh.uvs);
    EXPECT_EQ(info.mesh.face_uvs, sample.info.mesh.face_uvs);
  }
  if (frame_count > 0) {
    EXPECT_EQ(info.mesh.positions, sample.positions[0]);
  }
  std::vector<Vec3f> points;
  for (int f = 0; f < frame_count; ++f) {
    const auto i = static_cast<std::size_t>(f);
    ASSERT_TRUE((*reader)->read_frame(f, points));
    expect_same_points(sample.positions[i], points);
    ASSERT_EQ((*reader)->read_velocities(f, points).ok(), info.has_velocity);
    if (info.has_velocity) {
      expect_same_points(sample.velocities[i], points);
    }
  }
  for (const int outside : {-1, frame_count, frame_count + 1000}) EXPECT_FALSE((*reader)->read_frame(outside, points));
}

/// A damaged file: refused, or every frame reads as finite numbers or is refused.
void expect_harmless(const std::filesystem::path& path, std::uint64_t file_size) {
  auto reader = open_cache(path);
  if (!reader) return;
  const CacheInfo& info = (*reader)->info();
  ASSERT_LE(static_cast<std::uint64_t>(info.mesh.vertex_count()) * 12, file_size);
  for (const int v : info.mesh.face_vertices) ASSERT_TRUE(v >= 0 && v < info.vertex_count);
  ASSERT_TRUE(all_finite(info.mesh.positions));
  std::vector<Vec3f> points;
  for (int f = 0; f < std::min(info.frame_count, 100); ++f)
    if ((*reader)->read_frame(f, points)) {
      for (const Vec3f& p : points) ASSERT_TRUE(p.allFinite());
    }
}

TEST_P(CacheFormats, What_is_written_is_read_bit_for_bit) {
  const CacheSample sample = waving_patch(4, 3, 7);
  ASSERT_TRUE(write_cache(GetParam(), path(), sample, 7));
  expect_holds(sample, 7, path());
}

TEST_P(CacheFormats, A_cache_of_one_frame_and_of_no_frame_is_read) {
  for (const int frames : {0, 1}) {
    const CacheSample sample = waving_patch(2, 2, frames);
    ASSERT_TRUE(write_cache(GetParam(), path(), sample, frames));
    expect_holds(sample, frames, path());
  }
}

TEST_P(CacheFormats, A_mesh_of_one_face_is_read) {
  CacheSample sample = waving_patch(1, 1, 3);
  sample.info.mesh.face_sizes = {3};
  sample.info.mesh.face_vertices.resize(3);
  sample.info.mesh.face_uvs.resize(3);
  ASSERT_TRUE(write_cache(GetParam(), path(), sample, 3));
  expect_holds(sample, 3, path());
}

TEST_P(CacheFormats, Every_finished_frame_is_there_while_the_file_grows) {
  const CacheSample sample = waving_patch(3, 2, 9);
  auto writer = GetParam().open_writer(path(), sample.info, 0);
  ASSERT_TRUE(writer);
  expect_holds(sample, 0, path());
  for (int f = 0; f < 9; ++f) {
    const auto i = static_cast<std::size_t>(f);
    ASSERT_TRUE((*writer)->write_frame(sample.positions[i], sample.velocities[i]));
    EXPECT_EQ((*writer)->frame_count(), f + 1);
    expect_holds(sample, f + 1, path());
  }
}

TEST_P(CacheFormats, Resume_at_every_frame_gives_the_same_bytes) {
  const CacheSample sample = waving_patch(3, 2, 12);
  for (const int announced : {12, 3, 1}) {  // more frames than announced are written too
    CacheSample s = sample;
    s.info.frame_count = announced;
    ASSERT_TRUE(write_cache(GetParam(), path(), s, 12));
    const Bytes whole = bytes_of(path());
    for (int written = 0; written <= 12; ++written)
      for (int kept = 0; kept <= written; ++kept) {
        ASSERT_TRUE(write_cache(GetParam(), path("cut"), s, written));
        const Status status = write_cache(GetParam(), path("cut"), s, kept, kept);
        ASSERT_TRUE(status) << status.error().text();
        expect_holds(s, kept, path("cut"));
        ASSERT_TRUE(write_cache(GetParam(), path("cut"), s, 12, kept));
        ASSERT_EQ(bytes_of(path("cut")), whole)
            << "announced " << announced << ", written " << written << ", kept " << kept;
      }
  }
}

TEST_P(CacheFormats, Resume_of_what_is_not_there_is_refused_and_changes_nothing) {
  const CacheSample sample = waving_patch(3, 2, 6);
  EXPECT_FALSE(write_cache(GetParam(), path("none"), sample, 6, 2));
  EXPECT_FALSE(std::filesystem::exists(path("none")));
  ASSERT_TRUE(write_cache(GetParam(), path(), sample, 4));
  const Bytes before = bytes_of(path());
  EXPECT_FALSE(write_cache(GetParam(), path(), sample, 6, 5));
  CacheSample other = waving_patch(2, 3, 6);
  other.info.mesh.positions.pop_back();
  EXPECT_FALSE(write_cache(GetParam(), path(), other, 6, 2));
  EXPECT_EQ(bytes_of(path()), before);
}

TEST_P(CacheFormats, A_frame_that_is_not_finite_or_has_another_size_is_refused_and_the_next_good_one_is_not) {
  const CacheSample sample = waving_patch(2, 2, 3);
  auto writer = GetParam().open_writer(path(), sample.info, 0);
  ASSERT_TRUE(writer);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    auto x = sample.positions[0];
    x[4].y() = bad;
    const Status status = (*writer)->write_frame(x, {});
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().text().find("frame 1001, patch, vertex 4"), std::string::npos) << status.error().text();
  }
  EXPECT_FALSE((*writer)->write_frame(std::span(sample.positions[0]).first(3), {}));
  ASSERT_TRUE(write_frames(**writer, sample, 3));
  expect_holds(sample, 3, path());
}

TEST_P(CacheFormats, A_new_cache_replaces_an_old_one) {
  const CacheSample big = waving_patch(4, 4, 8), small = waving_patch(1, 1, 2);
  ASSERT_TRUE(write_cache(GetParam(), path("fresh"), small, 2));
  ASSERT_TRUE(write_cache(GetParam(), path(), big, 8));
  ASSERT_TRUE(write_cache(GetParam(), path(), small, 2));
  EXPECT_EQ(bytes_of(path()), bytes_of(path("fresh")));
}

TEST_P(CacheFormats, A_cache_cut_at_any_byte_is_refused) {
  const CacheSample sample = waving_patch(2, 1, 4);
  ASSERT_TRUE(write_cache(GetParam(), path(), sample, 4));
  auto file = OutputFile::open_existing(path());
  ASSERT_TRUE(file);
  for (std::uint64_t size = file->size().value(); size-- > 0;) {
    ASSERT_TRUE(file->truncate(size));
    ASSERT_FALSE(open_cache(path())) << "cut to " << size;
  }
}

TEST_P(CacheFormats, Any_flipped_bit_is_refused_or_harmless) {
  const CacheSample sample = waving_patch(2, 1, 3);
  ASSERT_TRUE(write_cache(GetParam(), path(), sample, 3));
  const Bytes whole = bytes_of(path());
  auto file = OutputFile::open_existing(path());
  ASSERT_TRUE(file);
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      const std::byte damaged = whole[i] ^ std::byte{1} << bit;
      ASSERT_TRUE(file->write_at(i, std::span(&damaged, 1)));
      expect_harmless(path(), whole.size());
      ASSERT_TRUE(file->write_at(i, std::span(&whole[i], 1)));
      if (testing::Test::HasFatalFailure()) FAIL() << "byte " << i << " bit " << bit;
    }
  expect_holds(sample, 3, path());
}

TEST_P(CacheFormats, Numbers_that_lie_are_refused_or_harmless) {
  const CacheSample sample = waving_patch(2, 1, 3);
  ASSERT_TRUE(write_cache(GetParam(), path(), sample, 3));
  const Bytes whole = bytes_of(path());
  auto file = OutputFile::open_existing(path());
  ASSERT_TRUE(file);
  const std::uint64_t lies[] = {~std::uint64_t{0}, std::uint64_t{1} << 63, 0x7fffffff7fffffff, 0, 1, 16, whole.size()};
  for (const std::uint64_t lie : lies)
    for (const std::size_t width : {4u, 8u})
      for (std::size_t at = 0; at + width <= whole.size(); at += 2) {
        ASSERT_TRUE(file->write_at(at, std::as_bytes(std::span(&lie, 1)).first(width)));
        expect_harmless(path(), whole.size());
        ASSERT_TRUE(file->write_at(at, std::span(whole).subspan(at, width)));
        if (testing::Test::HasFatalFailure()) FAIL() << "lie " << lie << " at " << at;
      }
  expect_holds(sample, 3, path());
}

TEST_P(CacheFormats, The_format_is_known_by_its_content_not_by_its_name) {
  const CacheSample sample = waving_patch(2, 1, 2);
  ASSERT_TRUE(write_cache(GetParam(), path(), sample, 2));
  for (const CacheFormat& other : cache_formats()) {
    const auto renamed = scratch_ / ("renamed" + std::string(other.extension));
    std::filesystem::copy_file(path(), renamed, std::filesystem::copy_options::overwrite_existing);
    expect_holds(sample, 2, renamed);
  }
}

TEST_P(CacheFormats, What_is_not_a_file_is_refused) {
  EXPECT_FALSE(open_cache(scratch_.path()));
  EXPECT_FALSE(open_cache(path("missing")));
  EXPECT_FALSE(open_cache("/dev/null"));
  put({}, path());
  EXPECT_FALSE(open_cache(path()));
  EXPECT_FALSE(GetParam().open_reader(path()));
  const CacheSample sample = waving_patch(1, 1, 1);
  EXPECT_FALSE(GetParam().open_writer(scratch_ / "no_folder/cache", sample.info, 0));
}

INSTANTIATE_TEST_SUITE_P(All, CacheFormats, testing::ValuesIn(cache_formats().begin(), cache_formats().end()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace ft::test
