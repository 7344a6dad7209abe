// Maps from the shot file to the solver: where values come from, what happens to them on the way, and what is said when
// they do not fit.
#include "baker/systems/cloth/vertex_maps.h"

#include "baker/core/file.h"
#include "baker/systems/cloth/cloth_maps.h"
#include "io/shot/mesh_file.h"
#include "solvers/energies/fabric.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

MapSpec map_from(const std::string& of, const std::string& from, double low, double high) {
  MapSpec map;
  map.of = of, map.from = from, map.low = low, map.high = high;
  return map;
}

/// The sheet of the fake scene with painted red and a group of faces.
Mesh painted_sheet() {
  Mesh mesh = FakeScene::sheet();
  mesh.groups.push_back({"collar", {0, 1, 2}, {1, 1, 1}});
  mesh.groups.push_back({"red", {4, 5}, {0.25, 1}});
  return mesh;
}

TEST(VertexMaps, Colours_and_groups_run_linearly_from_low_to_high) {
  const Mesh mesh = painted_sheet();
  for (const char* word : {"red", "r", "colour.r", "color.red", "Colour.Red"}) {
    const MapSpec maps[] = {map_from("thickness", word, 1e-3, 5e-3)};
    const auto out = resolve_maps(maps, mesh);
    ASSERT_TRUE(out) << out.error().text();
    ASSERT_EQ(out->thickness.size(), 9u);
    EXPECT_EQ(out->thickness[0], 1e-3);
    EXPECT_NEAR(out->thickness[4], 2e-3, 1e-18);
    EXPECT_EQ(out->thickness[5], 5e-3);
    EXPECT_TRUE(out->stretch.empty() && out->bend.empty() && out->mass_per_area.empty());
  }
  const MapSpec maps[] = {map_from("bend", "collar", 1, 20), map_from("stretch", "green", 1, 2),
                          map_from("mass_per_area", "r", 0.3, 0.1)};
  const auto out = resolve_maps(maps, mesh);
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(out->bend, (std::vector<double>{20, 20, 20, 1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(out->stretch, std::vector<double>(9, 1.0)) << "an unpainted channel of a painted mesh is 0";
  EXPECT_EQ(out->mass_per_area[5], 0.1);
}

TEST(VertexMaps, Welded_vertices_take_the_mean_and_equal_ones_keep_their_bits) {
  VertexMaps maps;
  maps.bend = {1, 0.1, 3, 0.1, 0.1};
  const std::vector<int> joined_of = {0, 1, 0, 1, 1};
  const VertexMaps out = on_joined(maps, joined_of, 2);
  EXPECT_EQ(out.bend, (std::vector<double>{2, 0.1}));
  EXPECT_TRUE(out.thickness.empty());
}

TEST(VertexMaps, The_range_of_mass_is_that_of_the_fabrics_key) {
  for (const FabricKey& key : fabric_keys())
    if (key.key == "mass_per_area") {
      EXPECT_EQ(find_map_kind("mass_per_area")->lowest, key.lowest);
      EXPECT_EQ(find_map_kind("mass_per_area")->highest, key.highest);
    }
}

void expect_fault(const BakeResult& result, int exit_code, const std::string& words) {
  EXPECT_EQ(result.exit_code, exit_code) << text(result);
  EXPECT_NE(text(result).find(words), std::string::npos) << text(result);
}

TEST(VertexMaps, What_does_not_fit_the_mesh_is_said_once_with_cloth_file_and_vertex) {
  FakeScene scene;
  const auto with = [&](const std::string& lines) {
    scene.write_shot(4, lines);
    return scene.run();
  };
  const auto numbers = [&](const std::string& numbers_text) {
    ASSERT_TRUE(write_text_durably(scene.file("t.csv"), numbers_text).ok());
  };
  const std::string map = "maps = [ { of = \"thickness\", file = \"t.csv\" } ]";
  numbers("1e-3\n2e-3\n");
  expect_fault(with(map), 3,
               "cloth \"sheet\": map of thickness: t.csv: has 2 lines of numbers, the mesh has 9 vertices");
  numbers("1e-3\n2e-3\n1e-3\n1e-3\n1e-3\n0.2\n1e-3\n1e-3\n1e-3\n");
  expect_fault(with(map), 3, "t.csv:6: = 0.2 for vertex 5 is outside [0.0005, 0.01] m");
  numbers("0\n0\n0\n0\n0\n0\n0\n0\n0\n");
  expect_fault(with("pins = [ { file = \"t.csv\" } ]"), 2, "t.csv: has no weight above 0: this pin holds nothing");
  numbers("0\n0\n0\n0\n0\n0\n0\n1.5\n0\n");
  expect_fault(with("pins = [ { file = \"t.csv\" } ]"), 3, "1.5 for vertex 7 is outside [0, 1]");
  expect_fault(with("maps = [ { of = \"bend\", from = \"colar\", low = 1, high = 2 } ]"), 2,
               "map of bend: from = \"colar\" names no vertex group and no colour of the mesh");
  numbers("1e-3\n2e-3\n1e-3\n1e-3\n1e-3\n2e-3\n1e-3\n1e-3\n1e-3\n");
  EXPECT_EQ(with(map).exit_code, 0);
}

TEST(VertexMaps, A_bake_is_stale_when_the_numbers_change_and_not_when_they_do_not) {
  FakeScene scene;
  const auto numbers = [&](double last) {
    ASSERT_TRUE(write_text_durably(scene.file("t.csv"), "1\n1\n1\n1\n1\n1\n1\n1\n" + std::to_string(last) + "\n").ok());
  };
  numbers(1);
  scene.write_shot(4, "maps = [ { of = \"bend\", file = \"t.csv\" } ]");
  ASSERT_EQ(scene.run().exit_code, 0) << text(scene.run());
  EXPECT_NE(text(scene.run()).find("up to date"), std::string::npos);
  numbers(2);
  BakeOptions options = scene.options();
  options.explain = true;
  EXPECT_NE(text(scene.run(options)).find("stale: t.csv changed"), std::string::npos) << text(scene.run(options));
}

}  // namespace
}  // namespace ft::test
