// What the conductor writes besides caches comes back as it was, and nothing spoilt is believed: checkpoint, manifest,
// reports.
#include <limits>

#include "baker/record/manifest.h"
#include "baker/record/report_json.h"
#include "baker/run/checkpoint.h"
#include "tests/baker/fake_bake.h"
#include "tests/support/damage.h"

namespace ft::test {
namespace {

using namespace std::string_view_literals;

FrameReport example_report(int frame) {
  FrameReport r;
  r.frame = frame;
  r.substeps = 7;
  r.crossings_self = 1;
  r.smallest_gap = 0.1 + 1e-17;
  r.strain_p99 = 1.0 / 3;
  r.finite = false;
  r.profile.linear = 0.25;
  Incident i;
  i.kind = Incident::Kind::k_released;
  i.frame = frame;
  i.system = "dress";
  i.vertex = 12;
  i.place = Vec3(1, 2.5, 1.0 / 7);
  i.depth = 4e-3;
  i.text = "no room: \"elbow\"";
  r.incidents = {i, i};
  r.incidents[1].kind = Incident::Kind::k_unsettled;
  InteractionForce f;
  f.system = "dress";
  f.mean = {Vec3(1.0 / 3, -5, 0), Vec3(0, 1e-17, 2)};
  f.peak = 6;
  f.contact_share = 0.75;
  r.forces = {f, f};
  r.forces[1].primary = "chair";
  return r;
}

Checkpoint example_checkpoint() {
  Checkpoint c;
  c.fingerprint = hash_text("inputs");
  c.frame = 12;
  State state;
  state.frame = 12;
  state.time = 0.5;
  state.block("x") = {1.0 / 3, 2, 3};
  c.states = {state, state};
  c.reports = {example_report(11), example_report(12)};
  c.before = {{1.5f, -2, 3}, {}};
  return c;
}

TEST(Checkpoint, Comes_back_bit_for_bit) {
  const Bytes bytes = save(example_checkpoint());
  auto loaded = load_checkpoint(bytes);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(save(*loaded), bytes);
  EXPECT_EQ(loaded->frame, 12);
  EXPECT_EQ(loaded->before, example_checkpoint().before);
  EXPECT_EQ(loaded->reports[0].smallest_gap, example_report(11).smallest_gap);
  EXPECT_EQ(loaded->reports[1].incidents[1].text, "no room: \"elbow\"");
  EXPECT_EQ(loaded->reports[1].incidents[1].kind, Incident::Kind::k_unsettled);
}

TEST(Checkpoint, Cut_at_any_byte_is_refused) {
  const Bytes bytes = save(example_checkpoint());
  for_each_cut(bytes, [](auto cut, std::size_t size) { EXPECT_FALSE(load_checkpoint(cut)) << size; });
}

TEST(Checkpoint, Any_flipped_bit_is_refused) {
  const Bytes bytes = save(example_checkpoint());
  for_each_flipped_bit(bytes, [](const Bytes& bad, std::size_t bit) { EXPECT_FALSE(load_checkpoint(bad)) << bit; });
}

TEST(Checkpoint, Lies_behind_a_good_hash_are_refused) {
  // The content hash keeps accidents out; a length that lies must not cost memory all the same.
  Bytes content = save(example_checkpoint());
  content.resize(content.size() - 16);
  for (std::size_t n = 24; n + 8 <= content.size(); n += 4) {
    Bytes bad = content;
    for (std::size_t k = 0; k < 8; ++k) bad[n + k] = std::byte{0x7f};
    const Hash128 hash = hash_bytes(bad);
    ByteWriter tail;
    tail.write(hash.low).write(hash.high);
    bad.insert(bad.end(), tail.bytes().begin(), tail.bytes().end());
    (void)load_checkpoint(bad).ok();  // either answer is right; what counts is that it comes
  }
}

TEST(ReportJson, Infinity_survives_as_null) {
  FrameReport r;
  r.smallest_gap = std::numeric_limits<double>::infinity();
  const Json json = to_json(r);
  EXPECT_TRUE(json["smallest_gap"].is_null());
  EXPECT_EQ(to_json(frame_report_from_json(json).value()), json);
}

TEST(ReportJson, Field_of_another_type_is_an_error_and_never_a_throw) {
  const Json good = to_json(example_report(3));
  for (const auto& item : good.items()) {
    for (const Json& wrong : {Json("text"), Json::array({1}), Json::object({{"a", 1}})}) {
      if (item.key() == "incidents" && wrong.is_array()) continue;
      Json bad = good;
      bad[item.key()] = wrong;
      EXPECT_FALSE(frame_report_from_json(bad)) << item.key();
    }
  }
  for (const Json& wrong : {Json(3), Json("x"), Json(nullptr), Json::array()})
    EXPECT_FALSE(frame_report_from_json(wrong));
}

TEST(Manifest, Comes_back_byte_for_byte) {
  FakeScene scene;
  ASSERT_EQ(scene
                .run(scene.options(), {{},
                                       [](int frame, FrameReport& r, State&) {
                                         if (frame % 3 == 0) r.incidents = example_report(frame).incidents;
                                       }})
                .exit_code,
            0);
  const std::string text = scene.manifest_text();
  auto manifest = manifest_from_text(text, "manifest.json");
  ASSERT_TRUE(manifest) << manifest.error().text();
  EXPECT_EQ(to_text(*manifest), text);
  EXPECT_TRUE(manifest->complete);
  EXPECT_EQ(manifest->frames.size(), 13u);
  EXPECT_EQ(manifest->systems.size(), 3u);
}

TEST(Manifest, Cut_or_mutated_text_is_read_or_refused_and_never_crashes) {
  FakeScene scene;
  scene.write_shot(2);
  ASSERT_EQ(scene.run().exit_code, 0);
  const std::string good = scene.manifest_text();
  for (std::size_t n = 0; n + 2 < good.size(); ++n) EXPECT_FALSE(manifest_from_text(good.substr(0, n), "m")) << n;
  const TextDamage damage{"0123456789.-+eE\"\\{}[],: \nutrefalsn\x00\x7f\xff"sv, 3, 20};
  for (std::uint64_t i = 0; i < 3000; ++i) {
    auto manifest = manifest_from_text(damaged(good, damage, i), "m");
    if (manifest) (void)to_text(*manifest);
  }
}

TEST(Manifest, Says_nothing_of_times_hosts_or_folders) {
  FakeScene scene;
  ASSERT_EQ(scene.run().exit_code, 0);
  const std::string text = scene.manifest_text();
  EXPECT_EQ(text.find(scene.folder().path.string()), std::string::npos);
  EXPECT_EQ(text.find("thread"), std::string::npos);
  EXPECT_EQ(text.find("seconds"), std::string::npos);
}

}  // namespace
}  // namespace ft::test
