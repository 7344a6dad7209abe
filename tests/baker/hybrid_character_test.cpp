// Imported characters that yield, through the whole path: shot file, import, hybrid pass, adjusted clip, files, bake.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "baker/core/file.h"
#include "baker/record/manifest.h"
#include "baker/record/report_json.h"
#include "tests/baker/fake_bake.h"
#include "tests/support/block_person.h"

namespace ft::test {
namespace {

constexpr double k_mass = 64.38, k_stiffness = 66e3;
constexpr double k_rest = k_mass * k_gravity / k_stiffness;  // 9.57 mm

const char* const k_mat =
    "[standin.mat]\nkind = \"mat\"\non = \"person\"\nsupport = \"replace\"\nstiffness = 66e3\n"
    "damping_ratio = 0.35\n";

class HybridCharacter : public ::testing::Test {
 protected:
  /// fps 30, no pre-roll, no cloth; the person weighs k_mass.
  void write(const std::vector<HipsKey>& keys, int frames, const std::string& primary, const std::string& rest,
             int fps = 30) {
    write_block_person(scene_.file("person.glb"), keys);
    std::ofstream(scene_.file("shot.toml"))
        << "[shot]\nframes = \"1-" << frames << "\"\nfps = " << fps << "\npreroll = 0\n[primary.person]\n"
        << "file = \"person.glb\"\nmass = " << k_mass << "\n"
        << primary << rest << "[cache]\nformats = [\"pc2\"]\n";
  }
  BakeServices services() const {
    BakeServices out = scene_.services();
    out.importer = import_primary;
    return out;
  }
  BakeResult run(bool resume = false, Progress* progress = nullptr) const {
    Progress silent;
    BakeOptions options = scene_.options();
    options.resume = resume;
    return bake(options, services(), progress ? *progress : silent);
  }
  Result<BakePlan> plan() const {
    ShotFaults faults;
    auto inputs = read_inputs(scene_.file("shot.toml"), {}, {}, faults);
    if (!inputs) return inputs.error();
    return make_plan(std::move(*inputs), import_primary, {});
  }
  static double lowest(const BakePlan& plan, double time) {
    const Trajectory& body = *plan.primaries[0].trajectory;
    std::vector<Vec3> x(at(body.surface().vertex_count()));
    body.sample(time, x);
    return bounds(x).lo.y();
  }
  FakeScene scene_;
};

/// Falls to the floor at 4 m/s and stops there at once, as a clip that was made on a hard floor.
std::vector<HipsKey> landing(int frames, double fps, double touch) {
  std::vector<HipsKey> out;
  for (int f = 0; f < frames; ++f) {
    const double t = f / fps, left = std::max(0.0, touch - t);
    out.push_back({t, 4 * left - 0.5 * k_gravity * left * left});
  }
  return out;
}

TEST_F(HybridCharacter, Standing_on_a_mat_it_sinks_by_its_weight_over_the_stiffness) {
  for (const char* limbs : {"rigid", "planted"}) {
    write({{0, 0}, {3, 0}}, 91, std::string("limbs = \"") + limbs + "\"\n", k_mat);
    const auto planned = plan();
    ASSERT_TRUE(planned) << planned.error().text();
    const HybridPass& pass = *planned->primaries[0].hybrid;
    EXPECT_NEAR(pass.offsets.back().position.y(), -k_rest, 1e-6);
    EXPECT_NEAR(pass.frames.back().mean.force.y(), k_mass * k_gravity, 0.1);
    EXPECT_NEAR(lowest(*planned, 3), -k_rest, 2e-6) << "the soles go along";
    ASSERT_EQ(planned->groups.size(), 1u) << "it is walked although nothing is baked on it";
  }
}

/// M x'' = -k x - c x' - M g from x = 0 at -4 m/s: the lowest place.
double lowest_by_formula(double ratio) {
  const double w = std::sqrt(k_stiffness / k_mass), damped = w * std::sqrt(1 - ratio * ratio);
  const double b = (-4 + ratio * w * k_rest) / damped;
  double out = 0;
  for (double t = 0; t < 0.2; t += 1e-5)
    out =
        std::min(out, -k_rest + std::exp(-ratio * w * t) * (k_rest * std::cos(damped * t) + b * std::sin(damped * t)));
  return out;
}

TEST_F(HybridCharacter, Landing_on_a_mat_it_sinks_as_a_mass_on_a_spring) {
  for (const int fps : {240, 60}) {
    write(landing(2 * fps, fps, 0.25), 2 * fps, "", k_mat, fps);
    const auto planned = plan();
    ASSERT_TRUE(planned) << planned.error().text();
    double deepest = 0;
    for (const RigidPose& offset : planned->primaries[0].hybrid->offsets)
      deepest = std::min(deepest, offset.position.y());
    // The clip stops within a frame, not at once: at 24 fps its legs take up a fifth of it.
    const double tolerance = fps == 240 ? 0.01 : 0.03;
    EXPECT_NEAR(deepest / lowest_by_formula(0.35), 1, tolerance) << fps;
    EXPECT_NEAR(planned->primaries[0].hybrid->offsets.back().position.y(), -k_rest, 1e-5) << fps;
  }
}

TEST_F(HybridCharacter, Planted_feet_are_not_lifted_when_the_mat_throws_the_body_up) {
  double highest[2] = {0, 0};
  for (const bool planted : {false, true}) {
    write(landing(60, 60, 0.25), 60, planted ? "limbs = \"planted\"\n" : "", k_mat, 60);
    const auto planned = plan();
    ASSERT_TRUE(planned) << planned.error().text();
    for (int f = 17; f < 60; ++f) highest[planted] = std::max(highest[planted], lowest(*planned, f / 60.0));
  }
  EXPECT_GT(highest[0], 5e-3);
  EXPECT_LT(highest[1], 0.2 * highest[0]);
}

TEST_F(HybridCharacter, Without_a_force_the_exported_glb_is_the_file_and_the_motion_the_clip) {
  write(landing(31, 30, 0.25), 31, "", std::string(k_mat) + "position = [0, -5, 0]\n");
  ASSERT_EQ(run().exit_code, 0) << text(run());
  EXPECT_EQ(read_file(scene_.folder().path / "person_hybrid.glb").value(),
            read_file(scene_.file("person.glb")).value());
  EXPECT_NE(scene_.manifest_text().find("standin \\\"mat\\\" never touches \\\"person\\\""), std::string::npos);
}

TEST_F(HybridCharacter, Weight_in_water_is_what_the_body_displaces) {
  write({{0, 0}, {1, 0}}, 31, "",
        "[standin.sea]\nkind = \"water\"\non = \"person\"\nsupport = \"replace\"\nposition = [0, 10, 0]\ndrag = 0\n");
  const auto planned = plan();
  ASSERT_TRUE(planned) << planned.error().text();
  // A person of 1010 kg/m3 below the surface sinks by the rest of its weight.
  const double a = k_gravity * (1 - 1000.0 / 1010);
  EXPECT_NEAR(planned->primaries[0].hybrid->offsets.back().position.y(), -0.5 * a, 1e-6);
}

TEST_F(HybridCharacter, Limits_and_the_way_back_are_kept) {
  const std::string weight = "[standin.load]\nkind = \"weight\"\non = \"person\"\nmass = 20\nuntil = 16\n";
  write({{0, 0}, {4, 0}}, 121, "max_displacement = 0.2\n", weight);
  auto planned = plan();
  ASSERT_TRUE(planned) << planned.error().text();
  EXPECT_NEAR(planned->primaries[0].hybrid->largest_displacement, 0.2, 1e-12);
  write({{0, 0}, {4, 0}}, 121, "comeback = \"window\"\ncomeback_frequency = 2\n", weight);
  planned = plan();
  ASSERT_TRUE(planned) << planned.error().text();
  EXPECT_GT(planned->primaries[0].hybrid->largest_displacement, 0.2);
  EXPECT_LT(planned->primaries[0].hybrid->offsets.back().position.norm(), 1e-4);
}

TEST_F(HybridCharacter, Its_files_are_in_the_manifest_and_missed_when_they_are_gone) {
  write({{0, 0}, {1, 0}}, 31, "", k_mat);
  ASSERT_EQ(run().exit_code, 0);
  const auto manifest = read_manifest(scene_.folder().path);
  ASSERT_EQ(manifest->files.size(), 3u);
  EXPECT_NE(text(run()).find("up to date"), std::string::npos);
  const auto sidecar = parse_json(read_text(scene_.folder().path / "person_hybrid.json").value(), "sidecar");
  EXPECT_EQ((*sidecar)["frames"].size(), 31u);
  EXPECT_EQ((*sidecar)["mass"], k_mass);
  for (const ManifestFile& file : manifest->files) {
    std::filesystem::remove(scene_.folder().path / file.file);
    BakeOptions options = scene_.options();
    options.explain = true;
    RecordedProgress progress;
    EXPECT_NE(text(bake(options, services(), progress)).find(file.file + " is gone"), std::string::npos);
    ASSERT_EQ(run().exit_code, 0);
  }
  write({{0, 0}, {1, 0}}, 31, "", "[cloth.sheet]\nmesh = \"sheet.obj\"\nfabric = \"cotton\"\n");
  ASSERT_EQ(run().exit_code, 0) << text(run());
  EXPECT_FALSE(std::filesystem::exists(scene_.folder().path / "person_hybrid.glb")) << "of the earlier bake";
}

TEST_F(HybridCharacter, Interrupted_it_goes_on_to_the_same_bytes) {
  for (const bool cloth : {false, true}) {
    const std::string sheet = cloth ? "[cloth.sheet]\nmesh = \"sheet.obj\"\nfabric = \"cotton\"\n" : "";
    write({{0, 0}, {1, 0}}, 31, "", k_mat + sheet);
    ASSERT_EQ(run().exit_code, 0);
    const auto expected = scene_.products();
    std::filesystem::remove_all(scene_.folder().path);
    RecordedProgress progress;
    progress.on_frame = [](int frame) { frame == 12 ? void(std::raise(SIGINT)) : void(); };
    ASSERT_EQ(run(false, &progress).exit_code, 130);
    ASSERT_EQ(run(true).exit_code, 0);
    EXPECT_EQ(scene_.products(), expected);
    std::filesystem::remove_all(scene_.folder().path);
  }
}

TEST_F(HybridCharacter, Faults_say_what_to_write) {
  const auto fault = [&](const std::string& primary, const std::string& rest, const std::string& words) {
    write({{0, 0}, {1, 0}}, 31, primary, rest);
    const BakeResult result = run();
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(text(result).find(words), std::string::npos) << text(result);
  };
  const std::string added = "[standin.mat]\nkind = \"mat\"\non = \"person\"\nstiffness = 66e3\n";
  fault("", added, "(support = \"replace\")");
  fault("limbs = \"plantd\"\n", k_mat, "(did you mean \"planted\"?)");
  fault("", std::string(k_mat) + "for = \"nothing\"\n", "has both for and on");
  fault("", "[standin.mat]\nkind = \"mat\"\non = \"persson\"\nstiffness = 1\n", "(did you mean \"person\"?)");
  fault("max_displacement = 0\n", k_mat, "max_displacement = 0 is outside");
  fault("", "", "there is nothing to bake");
}

}  // namespace
}  // namespace ft::test
