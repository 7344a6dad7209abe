// Files that OpenVDB wrote come back as the field that was put in, whatever way it is stored.
#include "io/volume/vdb_read.h"

#include <gtest/gtest.h>

#include "solvers/wind/velocity_grid.h"
#include "tests/io_volume/openvdb_sample.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

using test::SampleFile;
using test::SampleGrid;

Vec3 linear_field(const Vec3& p) {
  return {1 + 2 * p.x() - p.z(), 0.5 * p.y() - 3, p.x() + p.y() + 4 * p.z()};
}

SampleGrid sample(const std::string& name, SampleGrid::Kind kind = SampleGrid::k_vec3s, int component = 0) {
  SampleGrid out;
  out.name = name, out.kind = kind, out.component = component, out.field = linear_field;
  return out;
}

Result<VdbVelocity> read(const SampleFile& file, const std::string& grid = {}, const VdbOptions& options = {}) {
  const test::ScratchFolder scratch;
  test::write_vdb(scratch / "air.vdb", file);
  return read_vdb_velocity(scratch / "air.vdb", grid, options);
}

/// Every voxel has the field at its centre, to a share of the field's size.
void expect_field(const Result<VdbVelocity>& got, std::array<int, 3> count, double tolerance = 1e-6) {
  ASSERT_TRUE(got) << got.error().text();
  EXPECT_EQ(got->lowest, (std::array{-3, 2, 10}));
  ASSERT_EQ(got->count, count);
  std::size_t n = 0;
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i, ++n) {
        const Vec3 v = linear_field(got->to_world * Vec3(i - 3, j + 2, k + 10));
        ASSERT_LT((got->velocities[n].cast<double>() - v).norm(), tolerance * v.norm()) << i << ' ' << j << ' ' << k;
      }
  EXPECT_EQ(n, got->velocities.size());
}

constexpr std::array k_all{5, 4, 6}, k_cells{4, 3, 5};

TEST(Vdb_read, A_grid_of_floats_or_doubles_compressed_or_not) {
  for (const auto kind : {SampleGrid::k_vec3s, SampleGrid::k_vec3d})
    for (const bool blosc : {false, true})
      for (const bool seekable : {false, true}) {
        SampleFile file{{sample("density", SampleGrid::k_float), sample("vel", kind)}};
        file.blosc = blosc, file.seekable = seekable;
        const auto got = read(file);
        expect_field(got, k_all);
        ASSERT_TRUE(got);
        EXPECT_EQ(got->grid, "vel");
        EXPECT_TRUE(got->notes.empty());
        EXPECT_LT((got->to_world.matrix() - file.grids[1].to_world.matrix()).norm(), 1e-12);
      }
}

TEST(Vdb_read, Halves_have_three_digits) {
  SampleGrid grid = sample("vel");
  grid.half = true;
  expect_field(read({{grid}}), k_all, 1e-3);
}

TEST(Vdb_read, A_turned_stretched_grid) {
  SampleGrid grid = sample("v", SampleGrid::k_vec3d);
  grid.to_world = Eigen::Translation3d(1, -2, 0.5) * Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) *
                  Eigen::Scaling(0.1, 0.2, 0.05);
  expect_field(read({{grid}}), k_all);
}

TEST(Vdb_read, A_staggered_grid_is_averaged_to_centres) {
  SampleGrid grid = sample("vel");
  grid.staggered = true;
  const auto got = read({{grid}});
  expect_field(got, k_cells);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->notes.size(), 1u);
}

TEST(Vdb_read, Three_grids_of_numbers) {
  for (const std::string between : {".", "_", ""})
    for (const auto kind : {SampleGrid::k_float, SampleGrid::k_double}) {
      SampleFile file{{sample("density", SampleGrid::k_float)}};
      for (int c = 2; c >= 0; --c) file.grids.push_back(sample("wind" + between + "xyz"[c], kind, c));
      const auto got = read(file, between == "." ? "wind" : "");
      expect_field(got, k_all);
      ASSERT_TRUE(got);
      EXPECT_EQ(got->grid, "wind" + between + "x wind" + between + "y wind" + between + "z");
    }
}

TEST(Vdb_read, Three_grids_half_a_voxel_apart_are_staggered) {
  SampleFile file;
  for (int c = 0; c < 3; ++c) {
    file.grids.push_back(sample(std::string("vel.") + "xyz"[c], SampleGrid::k_float, c));
    file.grids.back().count = k_cells;
    ++file.grids.back().count[at(c)];
    file.grids.back().to_world.translate(-0.5 * Vec3::Unit(c));
  }
  expect_field(read(file), k_cells);
  file.grids[2].to_world.translate(Vec3(0.2, 0, 0));
  const auto apart = read(file);
  ASSERT_FALSE(apart);
  EXPECT_NE(apart.error().what.find("same voxels"), std::string::npos) << apart.error().text();
}

TEST(Vdb_read, A_tree_that_two_grids_share) {
  SampleFile file{{sample("other"), sample("vel")}};
  file.instanced = true;
  expect_field(read(file), k_all);
}

TEST(Vdb_read, Velocities_in_voxels_are_brought_to_the_files_units) {
  SampleGrid grid = sample("vel", SampleGrid::k_vec3d);
  grid.local = true;
  const auto got = read({{grid}});
  expect_field(got, k_all);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->notes.size(), 1u);
}

TEST(Vdb_read, A_grid_without_voxels_has_none) {
  SampleGrid grid = sample("vel");
  grid.count = {0, 0, 0};
  const auto got = read({{grid}});
  ASSERT_TRUE(got) << got.error().text();
  EXPECT_EQ(got->count, (std::array{0, 0, 0}));
}

TEST(Vdb_read, What_cannot_be_used_is_refused_by_name) {
  const auto refused = [](const SampleFile& file, const std::string& grid, const std::string& words,
                          const VdbOptions& options = {}) {
    const auto got = read(file, grid, options);
    ASSERT_FALSE(got) << words;
    EXPECT_EQ(got.error().kind, ErrorKind::k_input);
    EXPECT_NE(got.error().where.find("air.vdb"), std::string::npos);
    EXPECT_NE(got.error().what.find(words), std::string::npos) << got.error().text();
  };
  const SampleFile two{{sample("density", SampleGrid::k_float), sample("a"), sample("b")}};
  refused(two, "c", "no grid \"c\"; it has density (float), a (vec3s), b (vec3s)");
  refused(two, "density", "\"density\" holds no velocities");
  refused(two, "", "several grids");
  refused({{sample("n", SampleGrid::k_int)}}, "", "no grid of velocities; it has n (int32)");
  refused({}, "", "it has none at all");
  SampleGrid odd = sample("vel");
  odd.frustum = true;
  refused({{odd}}, "", "not linear in space");
  odd = sample("vel");
  odd.far_voxel = true;
  for (const bool seekable : {true, false})
    refused({.grids = {odd}, .seekable = seekable}, "", "more than 67108864 voxels");
  VdbOptions few;
  few.most_voxels = 119;
  refused({{sample("vel")}}, "", "more than 119 voxels", few);
  odd = sample("vel");
  odd.field = [](const Vec3&) { return Vec3(0, std::nan(""), 0); };
  refused({{odd}}, "", "not finite");
  VdbOptions without;
  without.reader = "/nowhere/followthrough_read_vdb";
  refused({{sample("vel")}}, "", "followthrough_read_vdb", without);
}

TEST(Vdb_read, Z_up_in_centimetres_becomes_wind_in_metres) {
  const Eigen::Affine3d turn(Eigen::AngleAxisd(-EIGEN_PI / 2, Vec3::UnitX()));  // z goes to y
  SampleGrid grid = sample("vel", SampleGrid::k_vec3d);
  grid.to_world = Eigen::Affine3d(Eigen::Scaling(100.0)) * turn.inverse() * grid.to_world;
  grid.field = [&](const Vec3& p) { return Vec3(turn.inverse() * Vec3(100 * linear_field(turn * Vec3(p / 100)))); };
  auto got = read({{grid}});
  ASSERT_TRUE(got) << got.error().text();
  to_metres(*got, 0.01, "z");
  VelocityVoxels frame{got->lowest, got->count, got->to_world, std::move(got->velocities)};
  const VelocityGrid wind({std::move(frame)}, 0, 24);
  for (const Vec3& index : {Vec3(-3, 2, 10), Vec3(-1.25, 3.5, 12.75), Vec3(0.9, 4.9, 14.9)}) {
    const Vec3 place = wind.frames()[0].to_world * index, v = linear_field(place);
    EXPECT_LT((wind.velocity(place, 0) - v).norm(), 1e-6 * v.norm());
  }
  EXPECT_LT((wind.frames()[0].to_world * Vec3::Zero() - Vec3(1, 2, 3)).norm(), 1e-9);
}

TEST(Vdb_read, Sequences_are_found_by_either_mark) {
  const test::ScratchFolder scratch;
  for (const int frame : {9, 10, 11}) {
    SampleGrid grid = sample("vel");
    grid.field = [frame](const Vec3&) { return Vec3(frame, 0, 0); };
    test::write_vdb(scratch / ("air." + std::string(frame < 10 ? "000" : "00") + std::to_string(frame) + ".vdb"),
                    {{grid}});
  }
  for (const char* pattern : {"air.####.vdb", "air.%04d.vdb", "air.#.vdb"}) {
    const auto found = find_vdb_sequence(scratch / pattern);
    ASSERT_TRUE(found) << found.error().text();
    EXPECT_EQ(found->first, 9);
    ASSERT_EQ(found->files.size(), 3u);
  }
  const auto found = find_vdb_sequence(scratch / "air.####.vdb");
  const auto frames = read_vdb_sequence(*found);
  ASSERT_TRUE(frames) << frames.error().text();
  EXPECT_EQ((*frames)[2].velocities[0], Vec3f(11, 0, 0));
  EXPECT_FALSE(read_vdb_sequence(*found, "", {}, 300));
  const auto one = find_vdb_sequence(scratch / "air.0010.vdb");
  ASSERT_TRUE(one);
  EXPECT_EQ(one->files.size(), 1u);
  EXPECT_FALSE(find_vdb_sequence(scratch / "water.####.vdb"));
  EXPECT_FALSE(find_vdb_sequence(scratch / "water.vdb"));
  std::filesystem::remove(scratch / "air.0010.vdb");
  const auto gap = find_vdb_sequence(scratch / "air.####.vdb");
  ASSERT_FALSE(gap);
  EXPECT_NE(gap.error().what.find("number 10 is missing"), std::string::npos);
}

}  // namespace
}  // namespace ft
