// Guides of hair: TressFX files, lines, hair meshes, Alembic curves; real ones, made-up ones, and damaged ones.
#include "io/hair/guides.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include "baker/core/output_frame.h"
#include "io/cache/cache.h"
#include "io/hair/resample.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

class Guides : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  std::string refusal(const std::filesystem::path& file) const {
    const auto read = read_guides(file, 1);
    return read ? "it was read" : read.error().text();
  }
  test::ScratchFolder folder_;
};

/// A TressFX file of strands that go up from x = their number, by 0.01 a vertex.
std::string tfx(std::uint32_t strands, std::uint32_t vertices, float version = 4) {
  std::string out(160, '\0');
  const std::uint32_t header[] = {strands, vertices, 160};
  std::memcpy(out.data(), &version, 4);
  std::memcpy(out.data() + 4, header, sizeof header);
  for (std::uint32_t s = 0; s < strands; ++s)
    for (std::uint32_t v = 0; v < vertices; ++v) {
      const float p[4] = {static_cast<float>(s), 0.01f * static_cast<float>(v), 0, 1};
      out.append(reinterpret_cast<const char*>(p), sizeof p);
    }
  return out;
}

TEST_F(Guides, A_TressFX_file_gives_its_strands_root_first_in_metres) {
  const auto read = read_guides(write("a.tfx", tfx(3, 5)), 2);
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->strands.size(), 3u);
  ASSERT_EQ(read->strands[2].size(), 5u);
  EXPECT_NEAR((read->strands[2][4] - Vec3(4, 0.08, 0)).norm(), 0, 1e-7);
}

TEST_F(Guides, Damaged_TressFX_files_are_refused_with_what_is_wrong) {
  const std::string good = tfx(3, 5);
  EXPECT_NE(refusal(write("cut.tfx", good.substr(0, good.size() - 1))).find("long enough for 14"), std::string::npos);
  EXPECT_NE(refusal(write("head.tfx", good.substr(0, 100))).find("header"), std::string::npos);
  EXPECT_NE(refusal(write("old.tfx", tfx(3, 5, 3))).find("version 3"), std::string::npos);
  EXPECT_NE(refusal(write("none.tfx", tfx(0, 5))).find("no strands"), std::string::npos);
  EXPECT_NE(refusal(write("points.tfx", tfx(3, 1))).find("2 are needed"), std::string::npos);
  std::string huge = good;
  std::memset(huge.data() + 4, 0xff, 8);
  EXPECT_NE(refusal(write("huge.tfx", huge)).find("long enough"), std::string::npos);
  std::string nan = good;
  const float bad = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(nan.data() + 160 + 16 * 7, &bad, 4);
  EXPECT_NE(refusal(write("nan.tfx", nan)).find("strand 1, vertex 2"), std::string::npos);
  for (std::size_t size = 0; size < good.size(); size += 7)  // no cut makes it crash
    EXPECT_NE(refusal(write("any.tfx", good.substr(0, size))).find("any.tfx"), std::string::npos);
}

TEST_F(Guides, Lines_of_an_OBJ_file_are_strands_whichever_way_it_counts) {
  const auto read = read_guides(write("a.obj",
                                      "v 0 0 0\nv 0 1 0\nv 0 2 0\nl 1 2 3\n"
                                      "v 5 0 0\nv 5 1 0\nvt 0 0\nl -2/1 -1/1\n"),
                                0.1);
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->strands.size(), 2u);
  EXPECT_EQ(read->strands[0].size(), 3u);
  EXPECT_NEAR((read->strands[1][1] - Vec3(0.5, 0.1, 0)).norm(), 0, 1e-12);
  for (const char* text : {"v 0 0 0\nl 1 2\n", "v 0 0 0\nv 0 1 0\nl 1 -3\n", "v 0 0 0\nv 0 1 0\nl 1 0\n", "v 0 0 0\n",
                           "", "v 0 0 0\nv 0 nan 0\nl 1 2\n", "v 0 0 0\nv 0 1e-9 0\nl 1 2\n"})
    EXPECT_NE(refusal(write("bad.obj", text)).find("bad.obj"), std::string::npos) << text;
}

/// A card of two columns, or a tube of six, that hangs from y = 1 down to 0 along a bow in x.
std::string hair_mesh(bool tube) {
  std::ostringstream out;
  const int around = tube ? 6 : 2, rows = 12;
  for (int r = 0; r < rows; ++r)
    for (int a = 0; a < around; ++a) {
      const double y = 1 - r / double(rows - 1), bow = 0.2 * std::sin(std::numbers::pi * y);
      const double angle = 2 * std::numbers::pi * a / around;
      const double x = tube ? 0.03 * std::cos(angle) : 0, z = tube ? 0.03 * std::sin(angle) : 0.05 * (a - 0.5);
      out << "v " << bow + x << " " << y << " " << z << "\n";
    }
  for (int r = 0; r + 1 < rows; ++r)
    for (int a = 0; a + (tube ? 0 : 1) < around; ++a) {
      const int b = (a + 1) % around, i = r * around + 1;
      out << "f " << i + a << " " << i + b << " " << i + around + b << " " << i + around + a << "\n";
    }
  return out.str();
}

TEST_F(Guides, The_middle_line_of_a_card_and_of_a_tube_is_their_strand) {
  for (const bool tube : {false, true}) {
    const auto file = write("mesh.obj", hair_mesh(tube));
    const auto read = read_guides(file, 1);
    ASSERT_TRUE(read) << read.error().text();
    ASSERT_EQ(read->strands.size(), 1u) << tube;
    const std::vector<Vec3>& line = read->strands[0];
    EXPECT_GT(line.front().y(), 0.9) << "the root is the higher end";
    EXPECT_LT(line.back().y(), 0.1);
    for (const Vec3& p : line) {
      // The last slices of a tube are parts of rings: there the line is only inside of it.
      const bool at_an_end = p.y() < 0.05 || p.y() > 0.95;
      EXPECT_NEAR(p.x(), 0.2 * std::sin(std::numbers::pi * p.y()), at_an_end ? 0.035 : 0.02);
      EXPECT_NEAR(p.z(), 0, at_an_end ? 0.03 : 0.01);
    }
    ASSERT_EQ(read->riders.size(), read->ridden.positions.size());
    for (std::size_t v = 0; v < read->riders.size(); ++v) {
      EXPECT_EQ(read->riders[v].strand, 0);
      EXPECT_NEAR(read->riders[v].along, 1 - read->ridden.positions[v].y(), 0.1);
    }
    const Vec3 below(0, -0.1, 0);
    const auto upward = read_guides(file, 1, {&below, 1});
    ASSERT_TRUE(upward) << upward.error().text();
    EXPECT_LT(upward->strands[0].front().y(), 0.1) << "the root is the end that is nearer to the scalp";
  }
}

TEST_F(Guides, Curves_of_an_Alembic_file_are_strands_with_their_widths) {
  const CacheFormat* format = nullptr;
  for (const CacheFormat& one : cache_formats())
    if (one.name == "abc") format = &one;
  ASSERT_NE(format, nullptr);
  CacheInfo info;
  info.system = "groom";
  info.frame_count = 1;
  info.content.shape = OutputShape::k_curves;
  info.curves.vertices_per_curve = {3, 2};
  for (int i = 0; i < 5; ++i) info.curves.rest.emplace_back(0.1 * i, 0.2 * i, 0);
  info.curves.widths = {1e-3f, 2e-3f};
  {
    auto writer = format->open_writer(folder_ / "a.abc", info, 0);
    ASSERT_TRUE(writer) << writer.error().text();
    FrameData frame;
    for (const Vec3& p : info.curves.rest) frame.positions.push_back(p.cast<float>());
    frame.velocities.resize(frame.positions.size(), Vec3f::Zero());
    ASSERT_TRUE((*writer)->write_frame(frame.view()));
    ASSERT_TRUE((*writer)->close());
  }
  const auto read = read_guides(folder_ / "a.abc", 0.5);
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->strands.size(), 2u);
  EXPECT_EQ(read->strands[0].size(), 3u);
  EXPECT_NEAR((read->strands[1][1] - Vec3(0.2, 0.4, 0)).norm(), 0, 1e-6);
  ASSERT_EQ(read->widths.size(), 2u);
  EXPECT_NEAR(read->widths[1], 1e-3, 1e-8);
  EXPECT_NE(refusal(write("bad.abc", "no archive")).find("bad.abc"), std::string::npos);
  EXPECT_NE(refusal(write("hair.txt", "")).find("hair.txt"), std::string::npos);
}

TEST_F(Guides, Real_files_give_strands_that_are_named_where_they_are_left_out) {
  for (const auto& [file, scale, least] : {std::tuple("tressfx_ratboy/Ratboy_mohawk.tfx", 1.0, 2219u),
                                           {"makehuman_hairmeshes/ponytail01.obj", 0.1, 40u},
                                           {"makehuman_hairmeshes/long01.obj", 0.1, 18u},
                                           {"makehuman_hairmeshes/braid01.obj", 0.1, 60u}}) {
    const std::filesystem::path path = test::assets_root() / "hair" / file;
    FT_REQUIRE_FILE(path);
    const auto read = read_guides(path, scale);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_GE(read->strands.size(), least) << file;
    for (const auto& strand : read->strands) {
      EXPECT_GE(length_of(strand), k_shortest_strand);
      EXPECT_LT(length_of(strand), 1.2) << file;
    }
  }
  const auto ratboy = read_guides(test::assets_root() / "hair/tressfx_ratboy/Ratboy_mohawk.tfx", 1);
  ASSERT_EQ(ratboy->notes.size(), 1u);
  EXPECT_NE(ratboy->notes[0].find("9 strands are shorter than 1 mm"), std::string::npos) << ratboy->notes[0];
}

TEST(Resample, Places_are_even_ends_stay_and_a_part_has_its_length) {
  const std::vector<Vec3> line{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 2, 0)};
  EXPECT_DOUBLE_EQ(length_of(line), 3);
  const std::vector<Vec3> even = resampled(line, 7);
  ASSERT_EQ(even.size(), 7u);
  EXPECT_EQ(even.front(), line.front());
  EXPECT_EQ(even.back(), line.back());
  for (std::size_t k = 0; k < 7; ++k) {
    const double s = 0.5 * static_cast<double>(k);
    EXPECT_NEAR((even[k] - (s < 1 ? Vec3(s, 0, 0) : Vec3(1, s - 1, 0))).norm(), 0, 1e-12) << k;
  }
  EXPECT_NEAR(length_of(cut_to(line, 1.7)), 1.7, 1e-12);
  EXPECT_EQ(cut_to(line, 9).size(), 3u);
}

}  // namespace
}  // namespace ft
