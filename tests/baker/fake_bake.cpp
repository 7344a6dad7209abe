#include "tests/baker/fake_bake.h"

#include <cmath>
#include <csignal>
#include <fstream>

#include "baker/core/file.h"
#include "baker/core/hash.h"
#include "baker/core/parallel.h"
#include "baker/judge/judge_caches.h"
#include "baker/record/manifest.h"
#include "io/shot/mesh_file.h"
#include "tests/baker/swarm_kind.h"
#include "tests/baker/tress_kind.h"
#include "tests/support/scripted_body.h"

namespace ft::test {
namespace {

/// A box of 1 m that bobs.
std::unique_ptr<Trajectory> bobbing_box(double preroll) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  Surface surface;
  surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  surface.parts = {{"box", -1, 1.0}};
  return std::make_unique<ScriptedBody>(std::move(surface), std::move(corners), preroll,
                                        [](double time, std::span<Vec3> x) {
                                          for (Vec3& p : x) p += Vec3(0, 0.1 * std::sin(3 * time), 0);
                                        });
}

class FakeSolver final : public Solver {
 public:
  FakeSolver(ClothSetup setup, FakeBehaviour behaviour) : setup_(std::move(setup)), behaviour_(std::move(behaviour)) {}

  int system_count() const override { return static_cast<int>(setup_.garments.size()); }
  const Mesh& system_mesh(int s) const override { return setup_.garments[static_cast<std::size_t>(s)].mesh; }
  void system_positions(const State& state, int s, std::span<Vec3> out) const override {
    const auto x = as_points(*state.find(std::string("x").append(std::to_string(s))));
    std::copy(x.begin(), x.end(), out.begin());
  }
  std::span<const Triangle> collider_triangles() const override { return setup_.primary->surface().triangles; }
  void collider_positions(const State& state, std::vector<Vec3>& out) const override {
    out.resize(at(setup_.primary->surface().vertex_count()));
    setup_.primary->sample(state.time, out);
  }
  std::vector<char> collider_absent(const State&, int) const override {
    return std::vector<char>(behaviour_.absent ? at(setup_.primary->surface().vertex_count()) : 0, 1);
  }
  State initial_state() const override {
    State state;
    state.frame = setup_.first_frame - setup_.preroll_frames;
    state.time = -setup_.preroll_frames / setup_.fps;
    for (int s = 0; s < system_count(); ++s)
      for (const Vec3& p : system_mesh(s).positions)
        for (int k = 0; k < 3; ++k) state.block(std::string("x").append(std::to_string(s))).push_back(p[k]);
    return state;
  }
  FrameReport advance_frame(State& state) override {
    if (behaviour_.on_frame) behaviour_.on_frame(state.frame + 1);
    ++state.frame;
    state.time = (state.frame - setup_.first_frame) / setup_.fps;
    double scale = 1;
    for (const ClothGarment& g : setup_.garments) scale += g.fabric.mass_per_area;
    for (StateBlock& block : state.blocks) {
      std::vector<double> values = block.values.read();
      for (double& v : values) v += 1e-3 * std::sin(10 * v + scale * state.frame);  // depends on all that went before
      block.values = std::move(values);
    }
    FrameReport report;
    report.frame = state.frame;
    report.substeps = 4;
    report.smallest_gap = 1e-3 * (1 + std::abs(std::sin(state.frame)));
    report.strain_p99 = 0.01;
    if (behaviour_.after_frame) behaviour_.after_frame(state.frame, report, state);
    return report;
  }

 private:
  ClothSetup setup_;
  FakeBehaviour behaviour_;
};

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

FakeScene::FakeScene(Beside beside) : beside_(beside) {
  if (beside == Beside::k_swarm) kind_.emplace(swarm_kind());
  if (beside == Beside::k_tress) kind_.emplace(tress_kind());
  write_file(file("box.glb"), "not looked into by the fake importer");
  write_garment(sheet());
  write_shot();
}

Mesh FakeScene::sheet() {
  std::vector<Vec3> x;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) x.emplace_back(1.05, 0.5 * j, 0.5 * i);
  const std::vector<Triangle> t = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4},
                                   {3, 4, 7}, {3, 7, 6}, {4, 5, 8}, {4, 8, 7}};
  return make_triangle_mesh("sheet", x, t);
}

void FakeScene::write_garment(const Mesh& mesh) {
  EXPECT_TRUE(write_obj(file("sheet.obj"), mesh).ok());
}

void FakeScene::write_shot(int last_frame, const std::string& cloth_lines, const std::string& extra) {
  write_file(
      file("shot.toml"),
      "[shot]\nframes = \"1-" + std::to_string(last_frame) +
          "\"\nfps = 24\npreroll = 3\n\n[primary.box]\nfile = \"box.glb\"\n\n[cloth.sheet]\nmesh = \"sheet.obj\"\n"
          "fabric = \"cotton\"\non = \"box\"\n" +
          cloth_lines +
          (beside_ == Beside::k_swarm   ? "\n[swarm.tokens]\non = \"box\"\n"
           : beside_ == Beside::k_tress ? "\n[tress.locks]\non = \"box\"\n"
                                        : "\n") +
          extra);
}

BakeOptions FakeScene::options() const {
  BakeOptions out;
  out.shot_file = file("shot.toml");
  out.folder = folder().path;
  return out;
}

BakeServices FakeScene::services(FakeBehaviour behaviour) const {
  return {[move = behaviour.move](const ImportRequest& request) -> Result<ImportedPrimary> {
            ImportedPrimary out;
            out.trajectory = bobbing_box(request.preroll);
            if (move) out.trajectory = move(*out.trajectory, request);
            out.info.bind_bounds.include(Vec3::Zero());
            out.info.bind_bounds.include(Vec3::Ones());
            return out;
          },
          [behaviour](SystemGroup& group) -> Result<std::unique_ptr<Solver>> {
            auto* cloth = dynamic_cast<ClothGroup*>(&group);
            if (!cloth) return group.make_solver();
            return std::unique_ptr<Solver>(std::make_unique<FakeSolver>(std::move(cloth->setup), behaviour));
          }};
}

BakeResult FakeScene::run(const BakeOptions& options, FakeBehaviour behaviour) const {
  Progress silent;
  return bake(options, services(std::move(behaviour)), silent);
}

std::map<std::string, std::string> FakeScene::products(const std::filesystem::path& folder) const {
  std::map<std::string, std::string> out;
  if (!std::filesystem::exists(folder)) return out;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != "report.json")
      out[entry.path().filename().string()] = hash_bytes(read_file(entry.path()).value()).hex();
  return out;
}

std::string FakeScene::manifest_text() const {
  return read_text(folder().manifest()).value();
}

std::string text(const BakeResult& result) {
  std::string out;
  for (const std::string& fault : result.faults) out += fault + "\n";
  for (const std::string& line : result.lines) out += line + "\n";
  return out;
}

namespace {

const Importer& no_files() {
  static const Importer none = [](const ImportRequest&) -> Result<ImportedPrimary> {
    return input_error("no files here");
  };
  return none;
}

}  // namespace

Result<BakePlan> plan_shot_in(const std::filesystem::path& folder) {
  ShotFaults faults;
  auto inputs = read_inputs(folder / "shot.toml", {}, {}, faults);
  if (!inputs) return inputs.error();
  return make_plan(std::move(*inputs), no_files(), {});
}

BakeResult bake_shot_in(const std::filesystem::path& folder, const std::string& name, int threads,
                        int interrupted_after, bool resume) {
  BakeOptions options;
  options.shot_file = folder / "shot.toml";
  options.folder = folder / name;
  options.resume = resume;
  const ThreadLimit limit(threads);
  RecordedProgress progress;
  int count = 0;
  progress.on_frame = [&](int) { ++count == interrupted_after ? void(std::raise(SIGINT)) : void(); };
  return bake(options, {no_files(), make_group_solver}, progress);
}

void expect_threads_and_interruptions_change_no_byte(const std::filesystem::path& folder, int interrupted_after) {
  const FakeScene any;
  const auto products = [&](const char* name) { return any.products(folder / name); };
  ASSERT_EQ(bake_shot_in(folder, "one").exit_code, 0);
  ASSERT_EQ(bake_shot_in(folder, "two", 2).exit_code, 0);
  EXPECT_EQ(products("two"), products("one"));
  EXPECT_EQ(bake_shot_in(folder, "again", 1, interrupted_after).exit_code, 130);
  ASSERT_EQ(bake_shot_in(folder, "again", 2, 0, true).exit_code, 0);
  EXPECT_EQ(products("again"), products("one"));
}

std::filesystem::path ShapesBakeTest::bake_with(const std::string& name,
                                                const std::vector<std::string>& overrides) const {
  BakeOptions options = scene_.options();
  options.folder = scene_.file(name);
  options.overrides = overrides;
  const BakeResult result = scene_.run(options);
  EXPECT_EQ(result.exit_code, 0) << text(result);
  return options.folder;
}

void ShapesBakeTest::falsify(const std::function<void(ManifestSystem&)>& change) const {
  auto manifest = read_manifest(scene_.folder().path);
  ASSERT_TRUE(manifest);
  for (ManifestSystem& system : manifest->systems)
    if (system.name == system_) change(system);
  ASSERT_TRUE(write_text_durably(scene_.folder().manifest(), to_text(*manifest)));
}

std::string ShapesBakeTest::judged() const {
  const auto judgement = judge_caches(scene_.folder().path);
  return judgement ? std::string() : judgement.error().text();
}

}  // namespace ft::test
