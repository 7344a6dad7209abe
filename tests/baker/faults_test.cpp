// What bad input and bad luck get: one message, the right exit code, nothing lost.
#include <cmath>
#include <fstream>

#include "baker/core/file.h"
#include "io/cache/cache.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

void expect_fault(const BakeResult& result, int exit_code, const std::string& words) {
  EXPECT_EQ(result.exit_code, exit_code) << text(result);
  EXPECT_NE(text(result).find(words), std::string::npos) << text(result);
}

TEST(Faults, Missing_shot_file_is_exit_code_3) {
  FakeScene scene;
  BakeOptions options = scene.options();
  options.shot_file = scene.file("absent.toml");
  expect_fault(scene.run(options), 3, "absent.toml");
}

TEST(Faults, Missing_garment_is_exit_code_3) {
  FakeScene scene;
  std::filesystem::remove(scene.file("sheet.obj"));
  expect_fault(scene.run(), 3, "sheet.obj");
}

TEST(Faults, All_faults_of_a_shot_file_come_at_once_with_exit_code_2) {
  FakeScene scene;
  scene.write_shot(10, "fabrik = \"cotton\"\nfriction = 17\n");
  const BakeResult result = scene.run();
  expect_fault(result, 2, "fabrik");
  expect_fault(result, 2, "friction");
  EXPECT_EQ(result.faults.size(), 2u);
}

TEST(Faults, Pin_group_that_does_not_exist_lists_those_that_do) {
  FakeScene scene;
  Mesh mesh = FakeScene::sheet();
  mesh.groups = {{"collar", {0, 1, 3, 4}, {1, 1, 1, 1}}};
  scene.write_garment(mesh);
  scene.write_shot(10, "pin = \"waist\"\n");
  const BakeResult result = scene.run();
  expect_fault(result, 2, "pin group \"waist\" does not exist");
  expect_fault(result, 2, "collar");
}

TEST(Faults, Pin_that_selects_nothing_states_the_smallest_distance) {
  FakeScene scene;
  scene.write_shot(10, "pins = [ { within = 0.01 } ]\n");
  expect_fault(scene.run(), 2, "the nearest vertex is 0.05 m from the body");
  scene.write_shot(10, "pins = [ { within = 0.0501 } ]\n");
  EXPECT_EQ(scene.run().exit_code, 0);
}

TEST(Faults, Pin_vertex_out_of_range_is_named) {
  FakeScene scene;
  scene.write_shot(10, "pins = [ { vertices = [0, 9] } ]\n");
  expect_fault(scene.run(), 2, "pin vertex 9 does not exist: the mesh has vertices 0-8");
}

TEST(Faults, Garment_that_cannot_be_simulated_is_refused) {
  FakeScene scene;
  Mesh mesh = FakeScene::sheet();
  mesh.positions[4] = mesh.positions[0];
  scene.write_garment(mesh);
  const BakeResult result = scene.run();
  EXPECT_TRUE(result.exit_code == 2 || result.exit_code == 3) << text(result);
  EXPECT_NE(text(result).find("cloth \"sheet\""), std::string::npos) << text(result);
}

TEST(Faults, Output_folder_that_cannot_be_written_is_exit_code_6) {
  FakeScene scene;
  BakeOptions options = scene.options();
  options.folder = scene.file("sheet.obj") / "below" / "a_file";
  expect_fault(scene.run(options), 6, "is not a folder");
  options.folder = "/proc/followthrough";
  expect_fault(scene.run(options), 6, "--out");
  options.dry_run = true;
  options.folder = scene.file("sheet.obj") / "below";
  EXPECT_EQ(scene.run(options).exit_code, 6);
}

TEST(Faults, Positions_that_are_not_finite_never_reach_a_cache) {
  FakeScene scene;
  const BakeResult result = scene.run(scene.options(), {{}, [](int frame, FrameReport&, State& state) {
                                                          if (frame == 6) state.block("x0")[5] = std::nan("");
                                                        }});
  expect_fault(result, 5, "frame 6: the solver returned positions that are not finite");
  auto cache = open_cache(scene.folder().path / "sheet.pc2");
  ASSERT_TRUE(cache);
  EXPECT_EQ((*cache)->info().frame_count, 5);
  std::vector<Vec3f> x;
  for (int i = 0; i < 5; ++i) EXPECT_TRUE((*cache)->read_frame(i, x).ok());
}

TEST(Faults, Frame_without_a_finite_step_is_exit_code_5_with_complete_caches) {
  FakeScene scene;
  const BakeResult result =
      scene.run(scene.options(), {{}, [](int frame, FrameReport& r, State&) { r.finite = frame != 7; }});
  expect_fault(result, 5, "frame 7");
  EXPECT_EQ(open_cache(scene.folder().path / "sheet.abc").value()->info().frame_count, 10);
}

TEST(Faults, Crossings_fail_the_gate_only_when_it_is_set) {
  FakeScene scene;
  const FakeBehaviour crossing{{}, [](int frame, FrameReport& r, State&) { r.crossings_self = frame == 4 ? 2 : 0; }};
  EXPECT_EQ(scene.run(scene.options(), crossing).exit_code, 0);
  scene.write_shot(10, "", "[gate]\ncrossings = true\n");
  BakeOptions again = scene.options();
  again.force = true;
  expect_fault(scene.run(again, crossing), 4, "frame 4: quality gate: 2 crossings");
}

TEST(Faults, Cloth_with_the_name_of_another_cache_is_refused) {
  FakeScene scene;
  const std::string shot = read_text(scene.file("shot.toml")).value();
  for (const char* name : {"cloth.box", "cloth.\"box.collider\""}) {
    std::string renamed = shot;
    renamed.replace(renamed.find("cloth.sheet"), 11, name);
    std::ofstream(scene.file("shot.toml")) << renamed;
    const BakeResult result = scene.run();
    EXPECT_EQ(result.exit_code, 2) << text(result);
    EXPECT_NE(text(result).find("box"), std::string::npos) << text(result);
  }
}

TEST(Faults, Error_of_the_importer_keeps_its_exit_code) {
  FakeScene scene;
  auto services = scene.services();
  services.importer = [](const ImportRequest&) -> Result<ImportedPrimary> {
    return usage_error("clip \"Walc\" does not exist", "box.glb", "there are: Walk");
  };
  Progress silent;
  expect_fault(bake(scene.options(), services, silent), 2, "there are: Walk");
}

TEST(Faults, Character_of_the_wrong_size_is_refused_with_a_way_out) {
  FakeScene scene;
  class Giant final : public Trajectory {
   public:
    explicit Giant(std::unique_ptr<Trajectory> small) : small_(std::move(small)) {}
    const Surface& surface() const override { return small_->surface(); }
    void bind_pose(std::span<Vec3> x) const override {
      small_->bind_pose(x);
      for (Vec3& p : x) p *= 175;
    }
    void sample(double, std::span<Vec3> x) const override { bind_pose(x); }
    Eigen::Isometry3d bind_to_start() const override { return Eigen::Isometry3d::Identity(); }
    double preroll() const override { return 0; }

   private:
    std::unique_ptr<Trajectory> small_;
  };
  auto services = scene.services();
  const auto import = services.importer;
  services.importer = [&](const ImportRequest& request) -> Result<ImportedPrimary> {
    auto out = import(request);
    out->trajectory = std::make_unique<Giant>(std::move(out->trajectory));
    return out;
  };
  Progress silent;
  expect_fault(bake(scene.options(), services, silent), 3, "the character is 175 m in size");
  BakeOptions said = scene.options();
  said.overrides = {"primary.box.unit_scale=1"};
  EXPECT_EQ(bake(said, services, silent).exit_code, 0);
}

TEST(Faults, A_folder_where_the_caches_would_overwrite_inputs_is_refused_before_anything_is_written) {
  FakeScene scene;
  BakeOptions options = scene.options();
  options.folder = scene.file("");
  for (const bool dry : {true, false}) {
    options.dry_run = dry;
    const BakeResult result = scene.run(options);
    EXPECT_EQ(result.exit_code, 2) << dry;
    EXPECT_NE(text(result).find("sheet.obj, which it reads (cloth.sheet.mesh)"), std::string::npos) << text(result);
  }
  EXPECT_FALSE(std::filesystem::exists(scene.file("manifest.json")));
  EXPECT_FALSE(std::filesystem::exists(scene.file(".state")));
}

}  // namespace
}  // namespace ft::test
