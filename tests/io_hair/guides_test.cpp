// Guides from files: the formats, what is refused, and real files where they are.
#include "io/hair/guides.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "baker/core/file.h"
#include "io/cache/cache.h"
#include "io/hair/resample.h"
#include "tests/support/assets.h"
#include "tests/support/damage.h"
#include "tests/support/shaped_samples.h"

namespace ft {
namespace {

using namespace std::string_view_literals;

class Guides : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, std::span<const std::byte> bytes) {
    const auto path = folder_ / name;
    EXPECT_TRUE(write_file_durably(path, bytes));
    return path;
  }
  std::filesystem::path write(const std::string& name, std::string_view text) {
    return write(name, std::as_bytes(std::span(text)));
  }
  /// The message of a file that has to be refused as an input that names itself.
  std::string refusal(const std::filesystem::path& path, double scale = 1) {
    const auto guides = read_guides(path, scale);
    EXPECT_FALSE(guides) << path;
    if (guides) return {};
    EXPECT_EQ(guides.error().kind, ErrorKind::k_input);
    EXPECT_NE(guides.error().text().find(path.filename().string()), std::string::npos) << guides.error().text();
    return guides.error().text();
  }
  std::string obj_refusal(std::string_view text) { return refusal(write("hair.obj", text)); }

  test::ScratchFolder folder_{test::ScratchFolder::k_in_memory};
};

struct TfxHeader {
  float version = 4;
  std::uint32_t strands = 2, vertices = 3, positions = 160, strand_uvs = 0, vertex_uvs = 0, thickness = 0, colours = 0;
};

/// Strand s has its vertices at (s, -v, 0).
Bytes tfx(const TfxHeader& h = {}, std::uint32_t strands = 2, std::uint32_t vertices = 3) {
  ByteWriter out;
  out.write(h);
  for (int i = 0; i < 32; ++i) out.write(std::uint32_t{0});
  for (std::uint32_t s = 0; s < strands; ++s)
    for (std::uint32_t v = 0; v < vertices; ++v)
      for (const float x : {static_cast<float>(s), -static_cast<float>(v), 0.0f, v < 2 ? 0.0f : 1.0f}) out.write(x);
  return out.take();
}

TEST_F(Guides, Tfx_strands_come_in_metres) {
  const auto guides = read_guides(write("a.tfx", tfx()), 0.01);
  ASSERT_TRUE(guides) << guides.error().text();
  const std::vector<std::vector<Vec3>> wanted = {{{0, 0, 0}, {0, -0.01, 0}, {0, -0.02, 0}},
                                                 {{0.01, 0, 0}, {0.01, -0.01, 0}, {0.01, -0.02, 0}}};
  EXPECT_EQ(guides->strands, wanted);
  EXPECT_TRUE(guides->notes.empty() && guides->widths.empty() && guides->riders.empty());
}

TEST_F(Guides, Short_strands_are_left_out_and_counted) {
  Bytes bytes = tfx();
  for (std::size_t v = 0; v < 3; ++v) std::memcpy(bytes.data() + 160 + 16 * v, bytes.data() + 160, 16);
  const auto guides = read_guides(write("a.tfx", bytes), 1);
  ASSERT_TRUE(guides) << guides.error().text();
  ASSERT_EQ(guides->strands.size(), 1u);
  EXPECT_EQ(guides->strands[0][0], Vec3(1, 0, 0));
  ASSERT_EQ(guides->notes.size(), 1u);
  EXPECT_NE(guides->notes[0].find("1 strands are shorter"), std::string::npos) << guides->notes[0];
  EXPECT_NE(refusal(write("a.tfx", tfx()), 1e-5).find("no curves of 1 mm"), std::string::npos);
}

TEST_F(Guides, Tfx_cut_at_any_byte_is_refused) {
  test::for_each_cut(tfx(), [&](std::span<const std::byte> bytes, std::size_t) { refusal(write("a.tfx", bytes)); });
}

TEST_F(Guides, Tfx_with_a_flipped_bit_is_refused_or_sound) {
  test::for_each_flipped_bit(tfx(), [&](const Bytes& bytes, std::size_t bit) {
    const auto guides = read_guides(write("a.tfx", bytes), 1);
    if (!guides) return;
    for (const auto& strand : guides->strands) {
      ASSERT_GE(strand.size(), 2u) << bit;
      ASSERT_TRUE(all_finite(strand)) << bit;
    }
  });
}

TEST_F(Guides, Tfx_headers_that_lie_are_refused) {
  const auto message = [&](const TfxHeader& h) { return refusal(write("a.tfx", tfx(h))); };
  EXPECT_NE(message({.version = 3}).find("version 3"), std::string::npos);
  EXPECT_NE(message({.version = std::nanf("")}).find("version"), std::string::npos);
  EXPECT_NE(message({.strands = 0}).find("no strands"), std::string::npos);
  EXPECT_NE(message({.vertices = 1}).find("1 vertices"), std::string::npos);
  EXPECT_NE(message({.positions = 8}).find("inside the header"), std::string::npos);
  EXPECT_NE(message({.positions = 4'000'000'000}).find("long enough for 0"), std::string::npos);
  EXPECT_NE(message({.strands = 4'294'967'295, .vertices = 4'294'967'295}).find("long enough for 6"),
            std::string::npos);
}

TEST_F(Guides, Tfx_positions_that_are_not_finite_are_refused) {
  Bytes bytes = tfx();
  const float nan = std::nanf("");
  std::memcpy(bytes.data() + 160 + 16 * 4, &nan, 4);
  EXPECT_NE(refusal(write("a.tfx", bytes)).find("strand 1, vertex 1"), std::string::npos);
  const float far = 1e30f;
  std::memcpy(bytes.data() + 160 + 16 * 4, &far, 4);
  EXPECT_NE(refusal(write("a.tfx", bytes)).find("1000 km"), std::string::npos);
}

TEST_F(Guides, Obj_lines_may_have_uvs_and_negative_indices_and_continue) {
  const auto guides = read_guides(write("a.OBJ",
                                        "v 0 0 0\nv 0 -1 0\nv 0 -2 0\nv 1 0 0\nv 1 -1 0\nvt 0 0\n"
                                        "l 1/1 2/1 3/1 # down\r\nl -1 \\\n-2\n"),
                                  1);
  ASSERT_TRUE(guides) << guides.error().text();
  const std::vector<std::vector<Vec3>> wanted = {{{0, 0, 0}, {0, -1, 0}, {0, -2, 0}}, {{1, -1, 0}, {1, 0, 0}}};
  EXPECT_EQ(guides->strands, wanted);
}

TEST_F(Guides, Obj_edges_are_joined_to_lines_from_their_first_vertex) {
  // Two lines edge by edge, in a muddle; a fork, whose arms stay three lines; a circle.
  const auto guides = read_guides(
      write("a.obj",
            "v 0 0 0\nv 0 -1 0\nv 0 -2 0\nv 0 -3 0\nv 1 0 0\nv 1 -1 0\nv 1 -2 0\n"
            "v 5 0 0\nv 5 -1 0\nv 6 -1 0\nv 4 -1 0\nv 9 0 0\nv 9 1 0\nv 9 1 1\n"
            "l 3 4\nl 2 1\nl 3 2\nl 5 6\nl 6 7\nl 8 9\nl 8 10\nl 8 11\nl 12 13\nl 13 14\nl 14 12\nf 1 2 5\n"),
      1);
  ASSERT_TRUE(guides) << guides.error().text();
  const std::vector<std::vector<Vec3>> wanted = {{{0, 0, 0}, {0, -1, 0}, {0, -2, 0}, {0, -3, 0}},
                                                 {{1, 0, 0}, {1, -1, 0}, {1, -2, 0}},
                                                 {{5, 0, 0}, {5, -1, 0}},
                                                 {{5, 0, 0}, {6, -1, 0}},
                                                 {{5, 0, 0}, {4, -1, 0}}};
  EXPECT_EQ(guides->strands, wanted);
  ASSERT_EQ(guides->notes.size(), 2u);
  EXPECT_NE(guides->notes[0].find("3 lines that close"), std::string::npos);
  EXPECT_NE(guides->notes[1].find("1 faces"), std::string::npos);
}

TEST_F(Guides, Obj_lines_that_name_nothing_are_refused) {
  EXPECT_NE(obj_refusal("v 0 0 0\nv 0 1 0\nl 1 3\n").find("hair.obj:3: line names vertex 3"), std::string::npos);
  EXPECT_NE(obj_refusal("v 0 0 0\nv 0 1 0\nl -1 -3\n").find("does not exist"), std::string::npos);
  EXPECT_NE(obj_refusal("v 0 0 0\nv 0 1 0\nl 0 1\n").find("count from 1"), std::string::npos);
  EXPECT_NE(obj_refusal("v 0 0 0\nv 0 1 0\nl 1\n").find("fewer than two"), std::string::npos);
  EXPECT_NE(obj_refusal("v 0 0 0\nv 0 1 0\nl 1 x\n").find("\"x\""), std::string::npos);
  EXPECT_NE(obj_refusal("v 0 0 0\nv 0 1 0\nl 1 99999999999999\n").find("does not exist"), std::string::npos);
  EXPECT_NE(obj_refusal("v 0 nan 0\nv 0 1 0\nl 1 2\n").find("not finite"), std::string::npos);
  EXPECT_NE(obj_refusal("v 0 1\nv 0 1 0\nl 1 2\n").find("for a number"), std::string::npos);
}

TEST_F(Guides, Files_without_curves_are_refused) {
  EXPECT_NE(obj_refusal("v 0 0 0\nv 0 1 0\n").find("holds no curves"), std::string::npos);
  EXPECT_NE(obj_refusal("").find("no vertices"), std::string::npos);
  EXPECT_NE(obj_refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").find("none of its pieces is a strip"),
            std::string::npos);
  EXPECT_NE(obj_refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 2 3\nl 3 1\n").find("no curves"), std::string::npos);
  EXPECT_NE(refusal(write("a.hair", "x")).find(".tfx, .obj or .abc"), std::string::npos);
  refusal(folder_ / "absent.obj");
  refusal(folder_ / "absent.tfx");
  refusal(folder_ / "absent.abc");
}

TEST_F(Guides, Damaged_obj_lines_are_refused_or_sound) {
  const std::string good =
      "v 0 0 0\nv 0 -1 0\nv 0 -2 0\nv 1 0 0\nv 1 -1 0\nv 1 -2 0.5\nl 1/1 2/1 3/1\nl -3 -2\nl 5 6\n";
  int accepted = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const auto guides =
        read_guides(write("a.obj", test::damaged(good, {.alphabet = "vlf -1234567890./\\\n\0e#"sv}, seed)), 1);
    if (!guides) continue;
    ++accepted;
    for (const auto& strand : guides->strands) {
      ASSERT_GE(strand.size(), 2u) << seed;
      ASSERT_TRUE(all_finite(strand)) << seed;
      ASSERT_GE(length_of(strand), k_shortest_strand) << seed;
    }
  }
  EXPECT_GT(accepted, 400);
  EXPECT_LT(accepted, 3600);
}

TEST_F(Guides, Alembic_curves_come_back_with_widths) {
  test::ShapedSample sample = test::strands(3);
  const auto path = folder_ / "groom.abc";
  ASSERT_TRUE(test::write_shaped(*find_cache_format("abc"), path, sample, 3));
  const auto guides = read_guides(path, 0.5);
  ASSERT_TRUE(guides) << guides.error().text();
  const CurveSet& curves = sample.info.curves;
  ASSERT_EQ(guides->strands.size(), curves.vertices_per_curve.size());
  std::size_t v = 0;
  for (std::size_t s = 0; s < guides->strands.size(); ++s) {
    EXPECT_EQ(guides->widths[s], 0.5 * double{curves.widths[v]});
    ASSERT_EQ(guides->strands[s].size(), at(curves.vertices_per_curve[s]));
    for (const Vec3& p : guides->strands[s]) EXPECT_EQ(p, 0.5 * curves.rest[v++]);
  }
}

TEST_F(Guides, Alembic_without_curves_or_cut_is_refused) {
  const auto path = folder_ / "sheet.abc";
  ASSERT_TRUE(test::write_shaped(*find_cache_format("abc"), path, test::sheet(2), 2));
  EXPECT_NE(refusal(path).find("holds no curves"), std::string::npos);
  const auto good = folder_ / "strands.abc";
  ASSERT_TRUE(test::write_shaped(*find_cache_format("abc"), good, test::strands(2), 2));
  const auto bytes = read_file(good);
  ASSERT_TRUE(bytes);
  for (std::size_t size = 0; size < bytes->size(); size += 7)
    refusal(write("cut.abc", std::span<const std::byte>(*bytes).first(size)));
}

/// A file of the assets, or none with the test skipped.
#define FT_HAIR_ASSET(path, name)                        \
  const auto path = test::assets_root() / "hair" / name; \
  FT_REQUIRE_FILE(path)

TEST(GuidesOfRealFiles, Mohawk) {
  FT_HAIR_ASSET(path, "tressfx_ratboy/Ratboy_mohawk.tfx");
  const auto guides = read_guides(path, 1);
  ASSERT_TRUE(guides) << guides.error().text();
  EXPECT_EQ(guides->strands.size(), 2219u);
  ASSERT_EQ(guides->notes.size(), 1u);
  EXPECT_NE(guides->notes[0].find("9 strands are shorter than 1 mm (the shortest 7.5e-06 m)"), std::string::npos)
      << guides->notes[0];
  double sum = 0;
  for (const auto& strand : guides->strands) sum += length_of(strand);
  EXPECT_NEAR(sum / 2228, 0.103, 0.001);  // as the description of the file says
}

struct HairMesh {
  const char* file;
  std::size_t strands;
  double least_length, most_length;  ///< m
};
void PrintTo(const HairMesh& mesh, std::ostream* out) {
  *out << mesh.file;
}
class GuidesOfHairMeshes : public testing::TestWithParam<HairMesh> {};

TEST_P(GuidesOfHairMeshes, Are_inside_the_mesh_and_carry_it) {
  FT_HAIR_ASSET(path, (std::string("makehuman_hairmeshes/") + GetParam().file));
  const auto guides = read_guides(path, 0.1);
  ASSERT_TRUE(guides) << guides.error().text();
  EXPECT_EQ(guides->strands.size(), GetParam().strands);
  const Mesh& mesh = guides->ridden;
  ASSERT_EQ(guides->riders.size(), mesh.positions.size());
  Box box = bounds(mesh.positions);
  box.inflate(0.005);  // what is led on beyond the last slice
  for (const auto& strand : guides->strands) {
    EXPECT_GT(length_of(strand), GetParam().least_length);
    EXPECT_LT(length_of(strand), GetParam().most_length);
    for (const Vec3& p : strand) EXPECT_TRUE(((p - box.lo).array() >= 0).all() && ((box.hi - p).array() >= 0).all());
  }
  // A rider is about where it says, and roots and tips have riders.
  std::vector<double> first(guides->strands.size(), 1), last(guides->strands.size(), 0);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Rider& rider = guides->riders[v];
    if (rider.strand < 0) continue;
    ASSERT_LT(at(rider.strand), guides->strands.size());
    ASSERT_TRUE(rider.along >= 0 && rider.along <= 1);
    const auto line = resampled(guides->strands[at(rider.strand)], 201);
    const double distance = (line[static_cast<std::size_t>(std::lround(200 * rider.along))] - mesh.positions[v]).norm();
    EXPECT_LT(distance, rider.of_strand ? 0.06 : k_rider_reach + 0.005) << v;
    if (!rider.of_strand) continue;
    first[at(rider.strand)] = std::min(first[at(rider.strand)], rider.along);
    last[at(rider.strand)] = std::max(last[at(rider.strand)], rider.along);
  }
  EXPECT_LT(*std::ranges::max_element(first), 0.1);
  EXPECT_GT(*std::ranges::min_element(last), 0.97);
}

INSTANTIATE_TEST_SUITE_P(MakeHuman, GuidesOfHairMeshes,
                         testing::Values(HairMesh{"long01.obj", 30, 0.6, 0.9}, HairMesh{"braid01.obj", 77, 0.05, 0.45},
                                         HairMesh{"ponytail01.obj", 48, 0.08, 0.4}),
                         [](const auto& one) {
                           std::string name = one.param.file;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace ft
