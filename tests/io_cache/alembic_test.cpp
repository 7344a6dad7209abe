// The Alembic writer and reader beyond the contract of all formats: no silent damage, size, sharing, archives of other
// programs.
#include <gtest/gtest.h>

#include "baker/core/file.h"
#include "baker/core/hash.h"
#include "io/cache/alembic_view.h"
#include "tests/support/assets.h"
#include "tests/support/cache_samples.h"

namespace ft::test {
namespace {

using namespace alembic;

const CacheFormat& abc() {
  return *find_cache_format("abc");
}

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(Murmur3, Gives_the_published_digests) {
  EXPECT_EQ(murmur3({}), (Key{0, 0}));
  EXPECT_EQ(murmur3(bytes_of("hello")), (Key{0xcbd8a7b341bd9b02, 0x5b1e906a48ae1d19}));
  EXPECT_EQ(murmur3(bytes_of("hello, world")), (Key{0x342fac623a5ebc8e, 0x4cdcbc079642414d}));
  EXPECT_EQ(murmur3(bytes_of("The quick brown fox jumps over the lazy dog.")),
            (Key{0xcd99481f9ee902c9, 0x695da1a38987b6e7}));
}

TEST(Alembic, Reversing_faces_twice_changes_nothing) {
  const Mesh mesh = waving_patch(3, 2, 0).info.mesh;
  std::vector<int> corners = mesh.face_vertices;
  reverse_faces(mesh.face_sizes, corners);
  EXPECT_NE(corners, mesh.face_vertices);
  EXPECT_EQ(std::vector<int>(corners.begin(), corners.begin() + 4), (std::vector<int>{1, 5, 4, 0}));
  reverse_faces(mesh.face_sizes, corners);
  EXPECT_EQ(corners, mesh.face_vertices);
}

// The public Alembic library (1.8.12) reads the file behind this hash: every sample, key, time, bound, uv and property,
// with the values written. When the bytes change on purpose, let it read the new ones before changing the hash.
TEST(Alembic, Writes_the_bytes_that_the_public_library_was_seen_to_read) {
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  const CacheSample sample = waving_patch(4, 3, 7);
  ASSERT_TRUE(write_cache(abc(), scratch / "a.abc", sample, 7));
  EXPECT_EQ(hash_bytes(read_file(scratch / "a.abc").value()).hex(), "3ab7c7b7ba11ba692a0c1948e1e7e262");
}

/// All that a reader gives of a file, as one hash; empty when it refuses.
std::string content(const std::filesystem::path& path) {
  auto reader = open_cache(path);
  if (!reader) return {};
  const CacheInfo& i = (*reader)->info();
  Hasher hasher;
  hasher.text(i.system).number(i.fps).number(i.first_frame).number(i.frame_count);
  for (const auto& [key, value] : i.metadata) hasher.text(key).text(value);
  for (const auto* list : {&i.mesh.face_sizes, &i.mesh.face_vertices, &i.mesh.face_uvs})
    hasher.bytes(list->data(), list->size() * sizeof(int));
  for (const Vec2& uv : i.mesh.uvs) hasher.number(uv.x()).number(uv.y());
  std::vector<Vec3f> points;
  for (int f = 0; f < i.frame_count; ++f)
    for (const bool velocities : {false, true}) {
      const Status status = velocities ? (*reader)->read_velocities(f, points) : (*reader)->read_frame(f, points);
      if (!status) return {};
      for (const Vec3f& p : points) hasher.number(p.x()).number(p.y()).number(p.z());
    }
  return hasher.digest().hex();
}

TEST(Alembic, Any_flipped_bit_is_refused_or_changes_nothing_that_is_read) {
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  const auto path = scratch / "a.abc";
  const CacheSample sample = waving_patch(2, 1, 3);
  ASSERT_TRUE(write_cache(abc(), path, sample, 3));
  const Bytes whole = read_file(path).value();
  const std::string wanted = content(path);
  ASSERT_FALSE(wanted.empty());
  auto file = OutputFile::open_existing(path);
  int refused = 0;
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (int bit = 0; bit < 8; bit += 1) {
      const std::byte damaged = whole[i] ^ std::byte{1} << bit;
      ASSERT_TRUE(file->write_at(i, std::span(&damaged, 1)));
      const std::string found = content(path);
      refused += found.empty();
      ASSERT_TRUE(found.empty() || found == wanted) << "byte " << i << " bit " << bit;
      ASSERT_TRUE(file->write_at(i, std::span(&whole[i], 1)));
    }
  EXPECT_GT(refused, 8 * 1000);
}

TEST(Alembic, The_file_costs_little_more_than_its_floats) {
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  for (const int announced : {0, 500}) {
    CacheSample sample = waving_patch(9, 9, 2);
    sample.info.frame_count = announced;
    auto writer = abc().open_writer(scratch / "a.abc", sample.info, 0);
    ASSERT_TRUE(writer);
    for (std::size_t f = 0; f < 500; ++f)
      ASSERT_TRUE((*writer)->write_frame(sample.positions[f % 2], sample.velocities[f % 2]));
    ASSERT_TRUE((*writer)->close());
    // Per frame: sizes and keys 3 x 24 B, the box 48 B, two tails of 40 B; twice as many tails and more when the frames
    // were not announced. Once: the mesh, and what is not samples in each tail.
    const std::size_t floats = 500 * 100 * 6 * sizeof(float), mesh = 100 * 12 + 81 * 4 + 324 * 4 * 2 + 101 * 8;
    const std::size_t per_frame = announced > 0 ? 200 : 360, tails = announced > 0 ? 2 : 8;
    EXPECT_LT(std::filesystem::file_size(scratch / "a.abc"), floats + mesh + 500 * per_frame + tails * 2048 + 512);
  }
}

TEST(Alembic, Frames_at_rest_share_their_data) {
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  CacheSample sample = waving_patch(9, 9, 1);
  sample.info.frame_count = 50;
  auto writer = abc().open_writer(scratch / "a.abc", sample.info, 0);
  ASSERT_TRUE(writer);
  for (int f = 0; f < 50; ++f) ASSERT_TRUE((*writer)->write_frame(sample.positions[0], sample.velocities[0]));
  const std::size_t floats_of_one_frame = 100 * 6 * sizeof(float);  // besides the mesh and two tails
  EXPECT_LT(std::filesystem::file_size(scratch / "a.abc"), floats_of_one_frame + 8192 + 2 * (50 * 40 + 2048));
  auto reader = open_cache(scratch / "a.abc");
  ASSERT_TRUE(reader);
  std::vector<Vec3f> points;
  ASSERT_TRUE((*reader)->read_frame(49, points));
  EXPECT_EQ(points[55], sample.positions[0][55].cast<float>());
}

TEST(Alembic, Velocities_come_with_every_frame_or_with_none) {
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  const CacheSample sample = waving_patch(2, 2, 3);
  for (const bool first : {true, false}) {
    auto writer = abc().open_writer(scratch / "a.abc", sample.info, 0);
    ASSERT_TRUE(writer);
    const auto velocities = [&](bool with) {
      return with ? std::span<const Vec3>(sample.velocities[1]) : std::span<const Vec3>();
    };
    ASSERT_TRUE((*writer)->write_frame(sample.positions[0], velocities(first)));
    EXPECT_FALSE((*writer)->write_frame(sample.positions[1], velocities(!first)));
    ASSERT_TRUE((*writer)->write_frame(sample.positions[1], velocities(first)));
    auto reader = open_cache(scratch / "a.abc");
    ASSERT_TRUE(reader);
    EXPECT_EQ((*reader)->info().has_velocity, first);
    EXPECT_EQ((*reader)->info().frame_count, 2);
  }
}

TEST(Alembic, Frame_rates_and_negative_frames_come_back) {
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  for (const double fps : {23.976, 24000 / 1001.0, 24.0, 25.0, 29.97, 30000 / 1001.0, 48.0, 49.0, 59.94, 60.0, 120.0})
    for (const int first : {-7, 0, 1, 1001, 100000}) {
      CacheSample sample = waving_patch(1, 1, 1);
      sample.info.fps = fps;
      sample.info.first_frame = first;
      ASSERT_TRUE(write_cache(abc(), scratch / "a.abc", sample, 1));
      auto reader = open_cache(scratch / "a.abc");
      ASSERT_TRUE(reader);
      EXPECT_DOUBLE_EQ((*reader)->info().fps, fps);
      EXPECT_EQ((*reader)->info().first_frame, first) << fps;
    }
}

/// Writes an archive whose samples stand before its tail.
class Foreign {
 public:
  template <class T>
  Sample add(const std::vector<T>& values) {
    const auto raw = std::as_bytes(std::span(values));
    return {data_.data(sample_payload(raw)), ogawa::k_empty_data, raw.size() + 16, murmur3(raw)};
  }
  std::filesystem::path save(const Archive& archive, const std::filesystem::path& path) {
    const std::uint64_t base = data_.end();
    ByteWriter out;
    ogawa::Reference root = 0;
    const Bytes tail = emit(archive, base, root), head = ogawa::header(root), data = data_.take();
    for (const Bytes* part : {&head, &data, &tail}) out.write_array(std::span<const std::byte>(*part));
    EXPECT_TRUE(write_file_durably(path, out.bytes()));
    return path;
  }

 private:
  ogawa::Builder data_{ogawa::k_header_size};
};

TEST(Alembic, Meshes_under_transforms_are_read_in_the_world) {
  using enum PropertyKind;
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  Foreign foreign;
  const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0}, speeds = {1, 2, 3, 0, 0, 0, 0, 0, 1};
  std::vector<Property> geom = {
      constant(k_array, "P", "", Pod::k_f32, 3, 1, foreign.add(points), 2),
      constant(k_array, ".faceIndices", "", Pod::k_i32, 1, 1, foreign.add(std::vector<int>{0, 2, 1}), 2),
      constant(k_array, ".faceCounts", "", Pod::k_i32, 1, 1, foreign.add(std::vector<int>{3}), 2),
      constant(k_array, ".velocities", "", Pod::k_f32, 3, 1, foreign.add(speeds), 2)};
  const Object mesh{"mesh", "schema=AbcGeom_PolyMesh_v1", {compound(".geom", "", geom)}, {}};
  // Inner: scale by 2, then 90 degrees around z (point -> rotate * scale). Outer: moves by 1 per frame along x.
  const std::vector<double> inner_values = {0, 0, 1, 90, 2, 2, 2};
  const Property inner =
      compound(".xform", "",
               {constant(k_scalar, ".ops", "", Pod::k_u8, 2, 0, foreign.add(std::vector<std::uint8_t>{2 << 4, 0}), 1),
                constant(k_scalar, ".vals", "", Pod::k_f64, 7, 0, foreign.add(inner_values), 1)});
  const auto outer = [&](bool moves) {
    const Sample samples[] = {foreign.add(std::vector<double>{10, 0, 0}),
                              foreign.add(std::vector<double>{moves ? 11.0 : 10.0, 0, 0})};
    return compound(".xform", "",
                    {constant(k_scalar, ".ops", "", Pod::k_u8, 1, 0, foreign.add(std::vector<std::uint8_t>{1 << 4}), 1),
                     animated(k_scalar, ".vals", "", Pod::k_f64, 3, 1, samples)});
  };
  for (const bool moves : {false, true}) {
    Archive archive;
    archive.time_samplings.push_back({2, 1 / 25.0, {1.0}});
    archive.top.children = {
        {"outer", "schema=AbcGeom_Xform_v3", {outer(moves)}, {{"inner", "schema=AbcGeom_Xform_v3", {inner}, {mesh}}}}};
    Foreign again = foreign;
    auto reader = open_cache(again.save(archive, scratch / "foreign.abc"));
    ASSERT_TRUE(reader) << reader.error().text();
    EXPECT_EQ((*reader)->info().first_frame, 25);
    EXPECT_EQ((*reader)->info().mesh.face_vertices, (std::vector<int>{1, 2, 0}));
    EXPECT_EQ((*reader)->info().has_velocity, !moves);
    std::vector<Vec3f> x;
    for (int f = 0; f < 2; ++f) {
      ASSERT_TRUE((*reader)->read_frame(f, x));
      const float along = moves && f == 1 ? 11 : 10;
      EXPECT_TRUE(x[0].isApprox(Vec3f(along, 0, 0)) && x[1].isApprox(Vec3f(along, 2, 0)) &&
                  x[2].isApprox(Vec3f(along - 2, 0, 0)));
    }
    if (!moves) {
      ASSERT_TRUE((*reader)->read_velocities(0, x));
      EXPECT_TRUE(x[0].isApprox(Vec3f(-4, 2, 6)));
    }
  }
}

TEST(Alembic, What_is_no_mesh_of_constant_topology_is_refused_by_name) {
  using enum PropertyKind;
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  const auto refusal = [&](std::vector<float> second, std::vector<int> corners, std::vector<int> sizes) {
    Foreign foreign;
    const Sample samples[] = {foreign.add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}), foreign.add(second)};
    std::vector<Property> geom = {animated(k_array, "P", "", Pod::k_f32, 3, 0, samples),
                                  constant(k_array, ".faceIndices", "", Pod::k_i32, 1, 0, foreign.add(corners), 1),
                                  constant(k_array, ".faceCounts", "", Pod::k_i32, 1, 0, foreign.add(sizes), 1)};
    Archive archive;
    archive.top.children = {{"mesh", "schema=AbcGeom_PolyMesh_v1", {compound(".geom", "", geom)}, {}}};
    auto reader = open_cache(foreign.save(archive, scratch / "bad.abc"));
    return reader ? std::string("read") : reader.error().what;
  };
  const std::vector<float> good(9, 0.5f);
  EXPECT_EQ(refusal(good, {0, 1, 2}, {3}), "read");
  EXPECT_EQ(refusal(std::vector<float>(12, 0.5f), {0, 1, 2}, {3}), "has a mesh whose topology changes");
  EXPECT_EQ(refusal(good, {0, 1, 3}, {3}), "is damaged: a face uses vertex 3");
  EXPECT_EQ(refusal(good, {0, 1, -1}, {3}), "is damaged: a face uses vertex -1");
  EXPECT_EQ(refusal(good, {0, 1, 2}, {4}), "is damaged: face sizes do not add up");
  EXPECT_EQ(refusal(good, {0, 1}, {2}), "has a face with 2 corners");
  EXPECT_EQ(refusal(good, {0, 1, 2}, {-3}), "has a face with -3 corners");
  EXPECT_EQ(refusal(good, {0, 1, 2}, {3, 2147483647, 2147483647}), "is damaged: face sizes do not add up");
  EXPECT_EQ(refusal(std::vector<float>(9, std::numeric_limits<float>::infinity()), {0, 1, 2}, {3}),
            "read");  // refused per frame
}

TEST(Alembic, Any_number_of_samples_survives_tree_to_bytes_to_tree) {
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  for (const std::uint32_t count : {0u, 1u, 2u, 255u, 256u, 65535u, 65536u}) {
    Foreign foreign;
    const Sample one = foreign.add(std::vector<float>{1, 2, 3}), two = foreign.add(std::vector<float>{4, 5, 6});
    for (const std::uint32_t first_changed : {1u, 3u, count}) {
      std::vector<Sample> samples(count, one);
      for (std::uint32_t i = first_changed; i < count; i += 2) samples[i] = two;
      Archive archive;
      archive.top.properties = {animated(PropertyKind::k_array, "P", "a=b", Pod::k_f32, 3, 0, samples)};
      Foreign again = foreign;
      auto file = InputFile::open(again.save(archive, scratch / "a.abc"));
      ASSERT_TRUE(file);
      const auto found = parse(*file);
      ASSERT_TRUE(found) << found.error().text();
      const Property& p = found.value().top.properties.at(0);
      ASSERT_EQ(p.sample_count, count);
      for (std::uint32_t i = 0; i < count; ++i) ASSERT_TRUE(p.samples[p.slot_of(i)].same_values(samples[i]));
    }
  }
}

TEST(Alembic, Groups_that_contain_each_other_are_refused_soon) {
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  // Every child of the group at 16 is that group.
  for (const std::uint64_t children : {2u, 6u, 1000u}) {
    ByteWriter out;
    const Bytes head = ogawa::header(16);
    out.write_array(std::span<const std::byte>(head)).write(children);
    for (std::uint64_t i = 0; i < children; ++i) out.write(std::uint64_t{16});
    ASSERT_TRUE(write_file_durably(scratch / "loop.abc", out.bytes()));
    EXPECT_FALSE(open_cache(scratch / "loop.abc"));
  }
}

}  // namespace
}  // namespace ft::test
