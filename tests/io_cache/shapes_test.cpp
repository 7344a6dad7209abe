// What the contract of all formats (contract_test.cpp) promises for meshes, for every shape that a format takes; and
// what it does not take is refused by name.
#include <gtest/gtest.h>

#include "baker/core/file.h"
#include "baker/core/hash.h"
#include "tests/support/assets.h"
#include "tests/support/shaped_samples.h"

namespace ft::test {
namespace {

struct Case {
  const CacheFormat* format;
  std::string shape;
};

ShapedSample sample_of(const std::string& name, int frames) {
  for (ShapedSample& s : all_shapes(frames))
    if (s.name == name) return s;
  ADD_FAILURE() << name;
  return {};
}

std::vector<Case> cases(bool taken) {
  std::vector<Case> out;
  for (const CacheFormat& format : cache_formats())
    for (const ShapedSample& s : all_shapes(0))
      if (format.accepts(s.info.content).ok() == taken) out.push_back({&format, s.name});
  return out;
}

class Shapes : public testing::TestWithParam<Case> {
 protected:
  const CacheFormat& format() const { return *GetParam().format; }
  ShapedSample sample(int frames) const { return sample_of(GetParam().shape, frames); }
  std::filesystem::path path(const std::string& name = "cache") const {
    return scratch_ / (name + std::string(format().extension));
  }
  Bytes bytes_of(const std::filesystem::path& p) const { return read_file(p).value(); }
  ScratchFolder scratch_{ScratchFolder::k_in_memory};
};
class RefusedShapes : public Shapes {};

template <class T>
std::vector<float> numbers(const std::vector<T>& values) {
  std::vector<float> out(values.size() * sizeof(T) / sizeof(float));
  if (!out.empty()) std::memcpy(out.data(), static_cast<const void*>(values.data()), out.size() * sizeof(float));
  return out;
}

void expect_same(const FrameData& wanted, const FrameData& found) {
  EXPECT_EQ(numbers(wanted.positions), numbers(found.positions));
  EXPECT_EQ(numbers(wanted.velocities), numbers(found.velocities));
  EXPECT_EQ(wanted.ids, found.ids);
  EXPECT_EQ(wanted.widths, found.widths);
  EXPECT_EQ(numbers(wanted.orientations), numbers(found.orientations));
  EXPECT_EQ(numbers(wanted.angular_velocities), numbers(found.angular_velocities));
  EXPECT_EQ(numbers(wanted.scales), numbers(found.scales));
  EXPECT_EQ(wanted.scalars, found.scalars);
  EXPECT_EQ(wanted.face_sizes, found.face_sizes);
  EXPECT_EQ(wanted.face_vertices, found.face_vertices);
}

FrameData positions_alone(const FrameData& frame) {
  FrameData out;
  out.positions = frame.positions;
  return out;
}

void expect_same_rest(const CacheInfo& wanted, const CacheInfo& found) {
  EXPECT_EQ(found.content.shape, wanted.content.shape);
  EXPECT_EQ(found.content.scalars, wanted.content.scalars);
  EXPECT_EQ(found.system, wanted.system);
  EXPECT_EQ(found.metadata, wanted.metadata);
  EXPECT_EQ(found.curves.vertices_per_curve, wanted.curves.vertices_per_curve);
  EXPECT_EQ(found.curves.ids, wanted.curves.ids);
  EXPECT_EQ(found.curves.rest, wanted.curves.rest);
  EXPECT_EQ(found.curves.widths, wanted.curves.widths);
  EXPECT_EQ(found.instances.ids, wanted.instances.ids);
  EXPECT_EQ(found.instances.prototypes, wanted.instances.prototypes);
  EXPECT_EQ(found.instances.prototype_names, wanted.instances.prototype_names);
  EXPECT_EQ(found.attributes, wanted.attributes);
}

/// The first frame_count frames of the sample are there, exactly, and nothing else.
void expect_holds(const ShapedSample& sample, int frame_count, const std::filesystem::path& path) {
  auto reader = open_cache_of_any_shape(path);
  ASSERT_TRUE(reader) << reader.error().text();
  const CacheInfo& info = (*reader)->info();
  ASSERT_EQ(info.frame_count, frame_count);
  EXPECT_EQ(info.first_frame, sample.info.first_frame);
  if (info.has_topology) expect_same_rest(sample.info, info);
  FrameData found;
  for (int f = 0; f < frame_count; ++f) {
    FrameData wanted = sample.frames[at(f)];
    const Status status = (*reader)->read(f, found);
    ASSERT_TRUE(status) << status.error().text();
    if (!info.has_topology) wanted = positions_alone(wanted);
    if (sample.info.content.changes && !info.content.changes) {  // so far nothing has changed
      EXPECT_EQ(info.mesh.face_vertices, wanted.face_vertices);
      wanted.face_sizes = wanted.face_vertices = {};
    }
    expect_same(wanted, found);
    if (testing::Test::HasFailure()) FAIL() << "frame " << f << " of " << frame_count;
  }
  for (const int outside : {-1, frame_count, frame_count + 1000}) EXPECT_FALSE((*reader)->read(outside, found));
}

/// All that a reader gives of a file, as one hash; empty when it refuses.
std::string content(const std::filesystem::path& path) {
  auto reader = open_cache_of_any_shape(path);
  if (!reader) return {};
  const CacheInfo& i = (*reader)->info();
  Hasher hasher;
  const auto add = [&](const auto& list) {
    hasher.number(list.size()).bytes(list.data(), list.size() * sizeof(list[0]));
  };
  hasher.text(i.system).number(i.fps).number(i.first_frame).number(i.frame_count);
  hasher.number(static_cast<std::uint8_t>(i.content.shape));
  add(i.mesh.face_sizes), add(i.mesh.face_vertices), add(i.curves.vertices_per_curve), add(i.curves.ids);
  add(i.curves.widths), add(i.curves.rest), add(i.instances.ids), add(i.instances.prototypes);
  for (const std::string& name : i.instances.prototype_names) hasher.text(name);
  for (const std::string& name : i.content.scalars) hasher.text(name);
  for (const CacheAttribute& a : i.attributes) {
    hasher.text(a.name).number(static_cast<std::uint8_t>(a.scope)).number(a.values.index());
    if (const auto* texts = std::get_if<std::vector<std::string>>(&a.values)) {
      for (const std::string& text : *texts) hasher.text(text);
    } else {
      std::visit([&](const auto& v) { hasher.bytes(v.data(), v.size() * sizeof(v[0])); }, a.values);
    }
  }
  FrameData f;
  for (int k = 0; k < std::min(i.frame_count, 100); ++k) {
    if (!(*reader)->read(k, f)) return {};
    add(f.positions), add(f.velocities), add(f.face_sizes), add(f.face_vertices), add(f.ids), add(f.widths);
    add(f.orientations), add(f.angular_velocities), add(f.scales);
    for (const auto& values : f.scalars) add(values);
  }
  return hasher.digest().hex();
}

TEST_P(Shapes, What_is_written_is_read_bit_for_bit_after_every_frame) {
  const ShapedSample s = sample(9);
  auto writer = format().open_writer(path(), s.info, 0);
  ASSERT_TRUE(writer) << writer.error().text();
  expect_holds(s, 0, path());
  for (int f = 0; f < 9; ++f) {
    const Status status = (*writer)->write_frame(s.frames[at(f)].view());
    ASSERT_TRUE(status) << status.error().text();
    EXPECT_EQ((*writer)->frame_count(), f + 1);
    expect_holds(s, f + 1, path());
  }
}

TEST_P(Shapes, Resume_at_every_frame_gives_the_same_bytes) {
  for (const int announced : {9, 2}) {  // more frames than announced are written too
    ShapedSample s = sample(9);
    s.info.frame_count = announced;
    ASSERT_TRUE(write_shaped(format(), path(), s, 9));
    const Bytes whole = bytes_of(path());
    for (int written = 0; written <= 9; ++written)
      for (int kept = 0; kept <= written; ++kept) {
        ASSERT_TRUE(write_shaped(format(), path("cut"), s, written));
        const Status status = write_shaped(format(), path("cut"), s, kept, kept);
        ASSERT_TRUE(status) << status.error().text();
        expect_holds(s, kept, path("cut"));
        ASSERT_TRUE(write_shaped(format(), path("cut"), s, 9, kept));
        ASSERT_EQ(bytes_of(path("cut")), whole) << "written " << written << ", kept " << kept;
      }
  }
}

TEST_P(Shapes, A_cache_cut_at_any_byte_is_refused) {
  ASSERT_TRUE(write_shaped(format(), path(), sample(3), 3));
  auto file = OutputFile::open_existing(path());
  for (std::uint64_t size = file->size().value(); size-- > 0;) {
    ASSERT_TRUE(file->truncate(size));
    ASSERT_FALSE(open_cache_of_any_shape(path())) << "cut to " << size;
  }
}

TEST_P(Shapes, No_flipped_bit_is_believed) {
  const bool checked = format().name != "pc2";  // which has no checksum: whatever finite is read, is read
  ASSERT_TRUE(write_shaped(format(), path(), sample(4), 4));
  const Bytes whole = bytes_of(path());
  const std::string wanted = content(path());
  auto file = OutputFile::open_existing(path());
  std::size_t refused = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const std::byte damaged = whole[i] ^ std::byte{1} << (i * 5 % 8);
    ASSERT_TRUE(file->write_at(i, std::span(&damaged, 1)));
    const std::string found = content(path());
    refused += found.empty();
    ASSERT_TRUE(!checked || found.empty() || found == wanted) << "byte " << i;
    ASSERT_TRUE(file->write_at(i, std::span(&whole[i], 1)));
  }
  EXPECT_GT(refused, 8u);
}

TEST_P(Shapes, Numbers_that_lie_are_refused_or_harmless) {
  ASSERT_TRUE(write_shaped(format(), path(), sample(3), 3));
  const Bytes whole = bytes_of(path());
  const std::string wanted = content(path());
  auto file = OutputFile::open_existing(path());
  for (const std::uint64_t lie : {~std::uint64_t{0}, std::uint64_t{1} << 63, std::uint64_t{0}, std::uint64_t{17}})
    for (std::size_t at = 0; at + 8 <= whole.size(); at += 4) {
      ASSERT_TRUE(file->write_at(at, std::as_bytes(std::span(&lie, 1))));
      content(path());
      ASSERT_TRUE(file->write_at(at, std::span(whole).subspan(at, 8)));
    }
  EXPECT_EQ(content(path()), wanted);
}

TEST_P(Shapes, A_frame_that_does_not_fit_is_refused_and_the_next_good_one_is_not) {
  const ShapedSample s = sample(4);
  auto writer = format().open_writer(path(), s.info, 0);
  ASSERT_TRUE(writer);
  ASSERT_TRUE((*writer)->write_frame(s.frames[0].view()));
  const auto refused = [&](auto spoil) {
    FrameData bad = s.frames[1];
    spoil(bad);
    const Status status = (*writer)->write_frame(bad.view());
    EXPECT_FALSE(status);
    const std::string text = status ? "" : status.error().text();
    EXPECT_NE(text.find("frame 1002, " + s.info.system), std::string::npos) << text;
  };
  refused([](FrameData& f) { f.positions[1].y() = std::numeric_limits<float>::quiet_NaN(); });
  refused([](FrameData& f) { f.velocities[0].x() = std::numeric_limits<float>::infinity(); });
  refused([](FrameData& f) { f.velocities.pop_back(); });
  refused([](FrameData& f) { f.ids.push_back(99); });
  refused([](FrameData& f) { f.widths.push_back(1); });
  refused([](FrameData& f) { f.scales.push_back(Vec3f(1, 1, 1)); });
  refused([](FrameData& f) { f.orientations.push_back(Eigen::Quaternionf::Identity()); });
  refused([](FrameData& f) { f.face_sizes = {3}, f.face_vertices = {0, 1, 9999}; });
  refused([](FrameData& f) { f.scalars.emplace_back(f.positions.size(), 1.0f); });
  if (!s.info.content.scalars.empty()) {
    refused([](FrameData& f) { f.scalars.pop_back(); });
    refused([](FrameData& f) { f.scalars[0].pop_back(); });
    refused([](FrameData& f) { f.scalars[0][1] = std::numeric_limits<float>::quiet_NaN(); });
  }
  if (GetParam().shape == "spray") refused([](FrameData& f) { f.ids[0] = f.ids[1]; });
  if (GetParam().shape == "leaves") refused([](FrameData& f) { f.orientations[2].coeffs() *= 1.01f; });
  for (int f = 1; f < 4; ++f) ASSERT_TRUE((*writer)->write_frame(s.frames[at(f)].view()));
  expect_holds(s, 4, path());
}

TEST_P(Shapes, The_estimate_of_a_frame_is_what_it_adds_to_the_file) {
  // What does not grow with the elements, keys and tails, is less than 600 bytes a frame.
  ShapedSample s = sample(9);
  FrameData& f = s.frames[8];
  const std::size_t before = s.info.content.changes ? s.frames[7].positions.size() : 0;
  if (before > 0) f = s.frames[7];
  for (std::size_t i = 0; before > 0 && i < 2000; ++i) {
    f.positions.push_back(f.positions[i % before] + Vec3f(1, static_cast<float>(i), 0));
    f.velocities.push_back(f.positions.back());
    for (auto& values : f.scalars) values.push_back(f.positions.back().y());
    if (s.info.content.widths) f.widths.push_back(0.5f), f.ids.push_back(i + (std::uint64_t{1} << 50));
  }
  ASSERT_TRUE(write_shaped(format(), path("short"), s, 8));
  ASSERT_TRUE(write_shaped(format(), path("long"), s, 9));
  const auto added = bytes_of(path("long")).size() - bytes_of(path("short")).size();
  const std::uint64_t estimate =
      format().bytes_per_frame(s.info.content, {f.positions.size(), f.face_sizes.size(), f.face_vertices.size()});
  EXPECT_GE(added, estimate);
  EXPECT_LE(added, estimate + 600);
}

TEST_P(Shapes, Only_meshes_of_constant_topology_open_where_these_are_wanted) {
  ASSERT_TRUE(write_shaped(format(), path(), sample(9), 9));
  const auto reader = open_cache(path());
  const bool wanted = GetParam().shape == "sheet" || GetParam().shape == "pool" || format().name == "pc2";
  EXPECT_EQ(reader.ok(), wanted);
}

TEST_P(RefusedShapes, What_a_format_cannot_hold_is_refused_by_name_and_no_file_is_touched) {
  const ShapedSample s = sample(3);
  const auto writer = format().open_writer(path(), s.info, 0);
  ASSERT_FALSE(writer);
  const std::string text = writer.error().text();
  const std::string what = s.info.content.shape == OutputShape::k_mesh ? "a mesh whose faces change"
                                                                       : std::string(shape_name(s.info.content.shape));
  EXPECT_NE(text.find("cannot hold " + what), std::string::npos) << text;
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST(CacheShapes, Grids_are_refused_by_every_format) {
  for (const CacheFormat& format : cache_formats()) {
    const Status status = format.accepts({.shape = OutputShape::k_grid});
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().text().find("cannot hold a grid"), std::string::npos);
  }
}

TEST(CacheShapes, Rest_data_that_do_not_agree_are_refused) {
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  const CacheFormat& abc = *find_cache_format("abc");
  const auto refused = [&](ShapedSample s, auto spoil) {
    spoil(s.info);
    EXPECT_FALSE(abc.open_writer(scratch / "a.abc", s.info, 0));
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.abc"));
  };
  refused(strands(1), [](CacheInfo& i) { i.curves.vertices_per_curve[0] = 5; });
  refused(strands(1), [](CacheInfo& i) { i.curves.vertices_per_curve = {4, 1, 4}; });
  refused(strands(1), [](CacheInfo& i) { i.curves.ids[0] = i.curves.ids[1]; });
  refused(strands(1), [](CacheInfo& i) { i.curves.ids[0] = std::uint64_t{1} << 31; });
  refused(strands(1), [](CacheInfo& i) { i.curves.widths.pop_back(); });
  refused(strands(1), [](CacheInfo& i) { i.attributes[1].scope = AttributeScope::k_vertex; });
  refused(strands(1), [](CacheInfo& i) { i.content.changes = true; });
  refused(leaves(1), [](CacheInfo& i) { i.instances.prototypes[2] = 2; });
  refused(leaves(1), [](CacheInfo& i) { i.instances.ids[0] = i.instances.ids[3]; });
  refused(leaves(1), [](CacheInfo& i) { i.instances.ids.pop_back(); });
  refused(spray(1), [](CacheInfo& i) { i.attributes = leaves(1).info.attributes; });
  for (const char* name : {"", "a/b", "foam", "Pref"})
    refused(pool(1), [&](CacheInfo& i) { i.content.scalars[1] = name; });
  refused(sheet(1), [](CacheInfo& i) { i.content.scalars = {"1", "2", "3", "4", "5", "6", "7", "8", "9"}; });
  refused(spray(1), [](CacheInfo& i) { i.content.scalars = {"foam"}; });
}

TEST(CacheShapes, A_format_says_which_scalars_it_does_not_keep) {
  const FrameContent content = pool(1).info.content;
  EXPECT_TRUE(find_cache_format("abc")->leaves_out(content).empty());
  EXPECT_EQ(find_cache_format("pc2")->leaves_out(content), content.scalars);
}

TEST(CacheShapes, Widths_for_each_curve_come_back_for_each_vertex) {
  ScratchFolder scratch{ScratchFolder::k_in_memory};
  ShapedSample s = strands(2);
  s.info.curves.widths = {1, 2, 3};
  ASSERT_TRUE(write_shaped(*find_cache_format("abc"), scratch / "a.abc", s, 2));
  auto reader = open_cache_of_any_shape(scratch / "a.abc");
  ASSERT_TRUE(reader);
  EXPECT_EQ((*reader)->info().curves.widths, (std::vector<float>{1, 1, 1, 1, 2, 2, 3, 3, 3}));
}

std::string name_of(const testing::TestParamInfo<Case>& tested) {
  return std::string(tested.param.format->name) + "_" + tested.param.shape;
}
INSTANTIATE_TEST_SUITE_P(All, Shapes, testing::ValuesIn(cases(true)), name_of);
INSTANTIATE_TEST_SUITE_P(All, RefusedShapes, testing::ValuesIn(cases(false)), name_of);

}  // namespace
}  // namespace ft::test
