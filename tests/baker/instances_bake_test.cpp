// Instances through the conductor: planned, written, judged, compared. tests/baker/resume_test.cpp interrupts them.
#include <cmath>
#include <functional>

#include "baker/commands/compare.h"
#include "baker/commands/compare_report.h"
#include "baker/core/file.h"
#include "baker/judge/judge_caches.h"
#include "baker/record/cache_track.h"
#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"
#include "tests/baker/fake_bake.h"
#include "tests/baker/swarm_kind.h"

namespace ft::test {
namespace {

class InstancesBake : public ShapesBakeTest {
 protected:
  InstancesBake() : ShapesBakeTest(Beside::k_swarm, "tokens") {}
  std::filesystem::path cache() const { return scene_.folder().path / "tokens.abc"; }
  static CompareReport of_tokens(const std::vector<CompareReport>& reports) {
    for (const CompareReport& r : reports)
      if (r.system == "tokens") return r;
    ADD_FAILURE() << "no report of the instances";
    return {};
  }
};

TEST_F(InstancesBake, Every_frame_is_what_the_solver_says_and_velocities_are_not_differences) {
  ASSERT_EQ(scene_.run().exit_code, 0);
  auto reader = open_cache_of_any_shape(cache());
  ASSERT_TRUE(reader) << reader.error().text();
  const CacheInfo& info = (*reader)->info();
  EXPECT_EQ(info.content.shape, OutputShape::k_instances);
  EXPECT_EQ(info.frame_count, 10);
  EXPECT_TRUE(info.has_velocity && info.content.angular_velocities && info.content.scales);
  ASSERT_EQ(info.instances.ids.size(), 12u);
  EXPECT_EQ(info.instances.ids.front(), 111u);
  EXPECT_EQ(info.instances.prototype_names, (std::vector<std::string>{"card", "wedge"}));
  FrameData now, next;
  for (int f = 0; f + 1 < 10; ++f) {
    ASSERT_TRUE((*reader)->read(f, now) && (*reader)->read(f + 1, next));
    for (std::size_t i = 0; i < 12; ++i) {
      EXPECT_EQ(now.scales[i], f < static_cast<int>(info.instances.ids[i] % 4) ? Vec3f(0, 0, 0) : Vec3f(1, 1, 0.5f))
          << f << " " << i;
      // The solver's step is an explicit one: the velocity is that of the way ahead, not of the way behind.
      const Vec3f way = 24 * (next.positions[i] - now.positions[i]);
      EXPECT_LT((way - now.velocities[i]).norm(), 1e-4f) << f << " " << i;
      // Turned by the angular velocity for a frame.
      const Vec3f spin = now.angular_velocities[i];
      const Eigen::Quaternionf turned(Eigen::AngleAxisf(spin.norm() / 24, spin.normalized()) * now.orientations[i]);
      EXPECT_LT(turned.angularDistance(next.orientations[i]), 2e-3f) << f << " " << i;  // single precision near 1
    }
  }
}

TEST_F(InstancesBake, Manifest_and_topology_name_the_prototypes) {
  ASSERT_EQ(scene_.run().exit_code, 0);
  const auto manifest = read_manifest(scene_.folder().path);
  ASSERT_TRUE(manifest) << manifest.error().text();
  EXPECT_EQ(to_text(*manifest), scene_.manifest_text());
  const auto tokens = std::find_if(manifest->systems.begin(), manifest->systems.end(),
                                   [](const ManifestSystem& s) { return s.name == "tokens"; });
  ASSERT_NE(tokens, manifest->systems.end());
  EXPECT_EQ(tokens->role, "swarm");
  EXPECT_EQ(tokens->shape, OutputShape::k_instances);
  EXPECT_EQ(tokens->count, 12);
  ASSERT_EQ(tokens->prototypes.size(), 2u);
  EXPECT_EQ(tokens->prototypes[1].name, "wedge");
  EXPECT_EQ(tokens->prototypes[1].vertex_count, 3);
  ASSERT_EQ(tokens->caches.size(), 1u);
  EXPECT_EQ(tokens->caches[0].file, "tokens.abc");
  EXPECT_EQ(tokens->caches[0].bytes, std::filesystem::file_size(cache()));
  const auto track = open_track(scene_.folder().path, *tokens, *manifest);
  ASSERT_TRUE(track) << track.error().text();
  const SystemShape shape = swarm_shape({});
  ASSERT_EQ(track->prototypes.size(), 2u);
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_EQ(track->prototypes[p].positions, shape.prototypes[p].positions);
    EXPECT_EQ(track->prototypes[p].face_vertices, shape.prototypes[p].face_vertices);
  }
  const auto obj = read_obj(scene_.folder().path / "tokens.obj");
  ASSERT_TRUE(obj);
  ASSERT_EQ(obj->groups.size(), 2u);
  EXPECT_EQ(obj->groups[0].name, "card");
}

TEST_F(InstancesBake, A_format_that_holds_meshes_only_is_left_out_with_a_note) {
  const std::string note = "swarm \"tokens\": PC2 cannot hold instances; it is written as abc only";
  BakeOptions options = scene_.options();
  options.dry_run = true;
  EXPECT_NE(text(scene_.run(options)).find("note: " + note), std::string::npos) << text(scene_.run(options));
  RecordedProgress progress;
  ASSERT_EQ(bake(scene_.options(), scene_.services(), progress).exit_code, 0);
  EXPECT_NE(progress.notes.find(note), std::string::npos) << progress.notes;
  EXPECT_EQ(progress.start.instance_count, 12);
  EXPECT_EQ(progress.start.vertex_count, 9);
  const auto manifest = read_manifest(scene_.folder().path);
  ASSERT_TRUE(manifest);
  EXPECT_EQ(std::count(manifest->notes.begin(), manifest->notes.end(), note), 1);
  EXPECT_FALSE(std::filesystem::exists(scene_.folder().path / "tokens.pc2"));
  EXPECT_TRUE(std::filesystem::exists(scene_.folder().path / "sheet.pc2"));
}

TEST_F(InstancesBake, Formats_of_which_none_holds_them_are_refused_before_the_first_frame) {
  for (const bool dry_run : {false, true}) {
    BakeOptions options = scene_.options();
    options.overrides = {"cache.formats=[\"pc2\"]"};
    options.dry_run = dry_run;
    int frames = 0;
    const BakeResult refused = scene_.run(options, {.on_frame = [&](int) { ++frames; }});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(frames, 0);
    for (const char* words : {"swarm \"tokens\"", "PC2 cannot hold instances", "take abc for instances"})
      EXPECT_NE(text(refused).find(words), std::string::npos) << text(refused);
  }
}

TEST_F(InstancesBake, The_estimate_is_what_the_format_says_that_frames_cost) {
  const auto estimate = [&](int count) {
    BakeOptions options = scene_.options();
    options.dry_run = true;
    options.overrides = {"swarm.tokens.count=" + std::to_string(count), "shot.frames=\"1-1000\""};
    const std::string lines = text(scene_.run(options));
    const std::size_t place = lines.find(", about ");
    EXPECT_NE(place, std::string::npos) << lines;
    return std::stod(lines.substr(place + 8));  // MB
  };
  const FrameContent content = swarm_shape({}).content;
  const double per_frame = static_cast<double>(find_cache_format("abc")->bytes_per_frame(content, {.elements = 90000}) -
                                               find_cache_format("abc")->bytes_per_frame(content, {.elements = 10000}));
  EXPECT_NEAR(1000 * estimate(90000) - estimate(10000), 1000 * per_frame * 1e-6, 200);  // printed in GB, and in MB
}

TEST_F(InstancesBake, Places_that_are_not_finite_never_reach_a_cache) {
  BakeOptions options = scene_.options();
  options.overrides = {"swarm.tokens.spoilt=6"};
  const BakeResult result = scene_.run(options);
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(text(result).find("frame 6: the solver returned positions that are not finite"), std::string::npos)
      << text(result);
  EXPECT_EQ(open_cache_of_any_shape(cache()).value()->info().frame_count, 5);
}

TEST_F(InstancesBake, Check_reads_every_frame_and_refuses_what_is_not_the_manifests) {
  ASSERT_EQ(scene_.run().exit_code, 0);
  const std::string good = scene_.manifest_text();
  EXPECT_EQ(judged(), "");
  using System = ManifestSystem;
  const std::vector<std::pair<std::function<void(System&)>, const char*>> lies = {
      {[](System& s) { s.count = 13; }, "has 12 instances, the manifest says 13"},
      {[](System& s) { s.prototypes[1].name = "wagon"; }, "other prototypes"},
      {[](System& s) { s.prototypes[0].vertex_count = 3; }, "faces between prototypes"},
      {[](System& s) { s.prototypes[1].face_count = 0; }, "has 7 vertices and 3 faces"},
      {[](System& s) { s.prototypes[1].face_count = -1; }, "negative"},
      {[](System& s) { s.shape = OutputShape::k_curves; }, "holds instances, the manifest says curves"}};
  for (const auto& [lie, words] : lies) {
    falsify(lie);
    EXPECT_NE(judged().find(words), std::string::npos) << judged();
    ASSERT_TRUE(write_text_durably(scene_.folder().manifest(), good));
  }
  // A frame of which a byte has flipped, somewhere in the file: read as it is or refused, and never not finite.
  Bytes bytes = read_file(cache()).value();
  const Bytes original = bytes;
  for (std::size_t k = 200; k < bytes.size(); k += 1999) {
    bytes = original;
    bytes[k] ^= std::byte{0x7f};
    ASSERT_TRUE(write_file_durably(cache(), bytes));
    (void)judged();
  }
}

TEST_F(InstancesBake, Bakes_that_differ_in_order_alone_are_equal) {
  const auto a = bake_with("a", {}), b = bake_with("b", {"swarm.tokens.turned=true"});
  const CompareReport r = of_tokens(compare_paths(a, b, 0));
  EXPECT_EQ(r.verdict, CompareVerdict::k_equal) << r.reason;
  EXPECT_EQ(summary(r), "no difference at all");
  ASSERT_TRUE(r.instances.has_value());
  EXPECT_EQ(r.instances->common, 12);
  EXPECT_TRUE(r.instances->same_set());
  EXPECT_EQ(r.instances->turn_max, 0);
}

TEST_F(InstancesBake, The_token_that_started_elsewhere_is_named_by_its_id) {
  const auto a = bake_with("a", {}), b = bake_with("b", {"swarm.tokens.nudge=0.25", "swarm.tokens.turned=true"});
  const CompareReport r = of_tokens(compare_paths(a, b, 1e-3));
  EXPECT_EQ(r.verdict, CompareVerdict::k_different);
  ASSERT_GE(r.worst, 0);
  const FrameDifference& worst = r.frames[at(r.worst)];
  EXPECT_EQ(r.element(worst.vertex), "instance 100");
  EXPECT_GT(worst.max, 0.2);
  EXPECT_NEAR(worst.rms, worst.max / std::sqrt(12.0), 1e-6);  // one of twelve differs
  EXPECT_GT(r.instances->p95, 0.2);                           // of twelve the worst is within the last twentieth
  EXPECT_EQ(r.instances->turn_max, 0);
  EXPECT_NE(compare_text({r}).find("positions: rms"), std::string::npos);
  EXPECT_EQ(of_tokens(compare_paths(a, b, 10)).verdict, CompareVerdict::k_equal);
}

TEST_F(InstancesBake, Ids_that_only_one_bake_has_are_listed) {
  const auto a = bake_with("a", {}), b = bake_with("b", {"swarm.tokens.first_id=102"});
  const CompareReport r = of_tokens(compare_paths(a, b, 1e3, 360));
  EXPECT_EQ(r.verdict, CompareVerdict::k_different);
  EXPECT_EQ(r.instances->common, 10);
  EXPECT_EQ(r.instances->missing, (std::vector<std::uint64_t>{100, 101}));
  EXPECT_EQ(r.instances->extra, (std::vector<std::uint64_t>{112, 113}));
  const std::string lines = compare_text({r});
  EXPECT_NE(lines.find("10 in both, 2 only in a (100, 101), 2 only in b (112, 113)"), std::string::npos) << lines;
  EXPECT_NE(compare_json({r}).find("\"missing\""), std::string::npos);
  EXPECT_NE(compare_junit({r}).find("failures=\"1\""), std::string::npos);
}

TEST_F(InstancesBake, Instances_and_a_mesh_cannot_be_compared) {
  ASSERT_EQ(scene_.run().exit_code, 0);
  const auto reports = compare_paths(cache(), scene_.folder().path / "sheet.abc", 0);
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].verdict, CompareVerdict::k_incomparable);
  EXPECT_NE(reports[0].reason.find("another shape: instances against a mesh"), std::string::npos) << reports[0].reason;
}

}  // namespace
}  // namespace ft::test
