// BVH, edited and made: spelling kept where nothing changes, the same motion read back, faults in words.
#include "io/export/bvh_export.h"

#include <cmath>

#include "baker/core/file.h"
#include "io/export/glb_from_character.h"
#include "io/import/bvh/bvh_file.h"
#include "io/import/import_cache.h"
#include "tests/io_export/moved.h"
#include "tests/support/damage.h"

namespace ft::test {
namespace {

std::vector<std::filesystem::path> sources() {
  const auto root = assets_root() / "mocap";
  return {root / "cmu_01_playground/01_01.bvh", root / "animateddrawings_fair1_child/dab.bvh",
          root / "animateddrawings_cmu_jacks/jumping_jacks.bvh", assimp_models_root() / "BVH/Boxing_Toes.bvh"};
}

PlacedCharacter place(const ImportRequest& request) {
  auto placed = place_character(request);
  EXPECT_TRUE(placed) << placed.error().text();
  return placed ? std::move(*placed) : PlacedCharacter{};
}

PlacedCharacter place_bvh(const std::filesystem::path& path) {
  ImportRequest request;
  request.file = path, request.body = "capsules";
  return place(request);
}

/// A node of the name in the other character; -1 when it has none.
int same_name(const Character& character, const std::string& name) {
  for (std::size_t n = 0; n < character.nodes.size(); ++n)
    if (character.nodes[n].name == name) return static_cast<int>(n);
  return -1;
}

TEST(BvhExport, Without_changes_it_is_the_same_bytes) {
  for (const auto& path : sources()) {
    FT_REQUIRE_FILE(path);
    const PlacedCharacter placed = place_bvh(path);
    EXPECT_EQ(export_bvh(path, placed.character, 0, {}).value(), read_text(path).value());
  }
}

TEST(BvhExport, A_deviation_comes_back_and_other_numbers_keep_their_spelling) {
  for (const auto& path : sources()) {
    FT_REQUIRE_FILE(path);
    SCOPED_TRACE(path.string());
    PlacedCharacter placed = place_bvh(path);
    MotionAdjustment adjustment = adjustment_of(placed);
    const double begin = 0.5 * placed.character.clips[0].end;
    adjustment.deviation = [&](double time) {
      const double w = std::clamp(2 * (time - begin), 0.0, 1.0);
      if (w == 0) return RootDeviation{};
      return RootDeviation{w * Vec3(0.1, -0.2, 0.3), Quat(Eigen::AngleAxisd(0.4 * w, Vec3(0.6, 0, 0.8))),
                           Vec3(0, 0.9, 0)};
    };
    for (const LimbChain& chain : find_limbs(placed.character))
      adjustment.limbs.push_back({chain, {}, [](double, const Vec3& imported) { return LimbTarget{imported, 0.5}; }});
    auto motion = adjust_motion(placed.character, placed.clip, placed.placement, adjustment);
    ASSERT_TRUE(motion) << motion.error().text();
    auto text = export_bvh(path, placed.character, placed.clip, motion->channels);
    ASSERT_TRUE(text) << text.error().text();

    const std::string original = read_text(path).value();
    const BvhFile a = read_bvh(original).value(), b = read_bvh(*text).value();
    ASSERT_EQ(a.values.size(), b.values.size());
    EXPECT_EQ(text->substr(0, text->find("MOTION")), original.substr(0, original.find("MOTION")));
    const auto quiet = static_cast<std::size_t>(begin / a.frame_time) * a.values_per_frame;
    EXPECT_TRUE(std::equal(a.values.begin(), a.values.begin() + static_cast<std::ptrdiff_t>(quiet), b.values.begin()));
    std::size_t changed_joints = 0;
    for (std::size_t j = 0; j < a.joints.size(); ++j) {
      bool differs = false;
      for (std::size_t f = 0; f < a.frame_count; ++f)
        for (std::size_t c = 0; c < a.joints[j].channels.size(); ++c) {
          const std::size_t v = f * a.values_per_frame + a.joints[j].first_value + c;
          differs = differs || a.values[v] != b.values[v];
        }
      changed_joints += differs;
      bool asked = false;
      for (const ChangedChannel& c : motion->channels) asked = asked || c.node == static_cast<int>(j);
      EXPECT_TRUE(asked || !differs) << a.joints[j].name;
    }
    EXPECT_GE(changed_joints, 1u);

    ScratchFolder scratch;
    ASSERT_TRUE(write_text_durably(scratch / "moved.bvh", *text));
    PlacedCharacter again = place_bvh(scratch / "moved.bvh");
    again.placement = placed.placement;  // guessed from its skeleton
    ASSERT_TRUE(apply_changes(placed.character, placed.clip, motion->channels));
    double worst = 0;
    for (std::size_t f = 0; f < a.frame_count; f += 7) {
      const double time = static_cast<double>(f) * a.frame_time;
      const auto x = nodes_at(placed, time), y = nodes_at(again, time);
      for (std::size_t n = 0; n < x.size(); ++n) worst = std::max(worst, (place_of(x[n]) - place_of(y[n])).norm());
    }
    std::printf("%s: %.2e m off\n", path.filename().c_str(), worst);
    EXPECT_LT(worst, 1e-4 * placed.info.bind_bounds.size().y());
  }
}

TEST(BvhExport, A_bvh_and_a_glb_made_of_any_skeleton_have_its_joints) {
  for (const MovedCase& c : moved_cases()) {
    FT_REQUIRE_FILE(c.request.file);
    SCOPED_TRACE(c.name);
    const PlacedCharacter placed = place(c.request);
    const BvhFrames frames{placed.playback.start, 1.0 / 24, 14};
    auto text = bvh_from_character(placed.character, placed.clip, placed.placement, frames);
    ASSERT_TRUE(text) << text.error().text();
    std::vector<std::string> notes;
    auto bytes = glb_from_character(placed.character, placed.clip, placed.placement, notes);
    ASSERT_TRUE(bytes) << bytes.error().text();
    ScratchFolder scratch;
    ASSERT_TRUE(write_text_durably(scratch / "made.bvh", *text));
    ASSERT_TRUE(write_file_durably(scratch / "made.glb", *bytes));
    for (const char* made : {"made.bvh", "made.glb"}) {
      auto loaded = load_character(scratch / made, {}, {});
      ASSERT_TRUE(loaded) << loaded.error().text();
      PlacedCharacter again;  // both are metres and Y up
      again.character = std::move(loaded->character);
      again.clip = 0;
      const bool bvh = again.character.format == "BVH";
      double worst = 0;
      int compared = 0;
      for (int f = 0; f < frames.count; ++f) {
        const double time = f * frames.time;
        const auto x = nodes_at(placed, placed.playback.start + time),
                   y = nodes_at(again, bvh ? time : placed.playback.start + time);
        for (std::size_t n = 0; n < x.size(); ++n)
          if (const int other = same_name(again.character, placed.character.nodes[n].name); other >= 0) {
            worst = std::max(worst, (place_of(x[n]) - place_of(y[at(other)])).norm());
            ++compared;
          }
      }
      std::printf("%s %s: %.2e m off at %d joints\n", c.name, made, worst, compared / frames.count);
      EXPECT_GE(compared / frames.count, 19);
      EXPECT_LT(worst, (bvh ? 1e-4 : 1e-6) * placed.info.bind_bounds.size().y());
    }
    // The .glb plays on the character as its animation file.
    ImportRequest request = c.request;
    request.animation = scratch / "made.glb";
    const PlacedCharacter replayed = place(request);
    double worst = 0;
    for (double time = placed.playback.start; time < placed.playback.start + 0.5; time += 0.021) {
      const auto x = nodes_at(placed, time), y = nodes_at(replayed, time);
      for (std::size_t n = 0; n < x.size(); ++n) worst = std::max(worst, (place_of(x[n]) - place_of(y[n])).norm());
    }
    EXPECT_LT(worst, 2e-6);
  }
}

const std::string k_small =
    "HIERARCHY\nROOT a\n{\n\tOFFSET 0 0 0\n\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "\tJOINT b\n\t{\n\t\tOFFSET 0 1 0\n\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n\t\tEnd Site\n\t\t{\n"
    "\t\t\tOFFSET 0 1 0\n\t\t}\n\t}\n}\nMOTION\nFrames: 2\nFrame Time: .04\n0 1e0 0 +10 0 0  0 0 0\n0 2 0 0 0 0 5.50 0 "
    "0\n";

TEST(BvhExport, Says_what_is_wrong_with_a_file) {
  const auto fault = [](const std::string& from, const std::string& to) {
    std::string text = k_small;
    text.replace(text.find(from), from.size(), to);
    auto file = read_bvh(text);
    return file ? std::string("no fault") : file.error().text();
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_PRED2(has, fault("HIERARCHY", "HIERARCHIE"), "HIERARCHY");
  EXPECT_PRED2(has, fault("JOINT b", "JOIN b"), "\"JOIN\"");
  EXPECT_PRED2(has, fault("OFFSET 0 1 0", "OFFSET 0 x 0"), "joint \"b\"");
  EXPECT_PRED2(has, fault("CHANNELS 6", "CHANNELS 7"), "joint \"a\"");
  EXPECT_PRED2(has, fault("Zposition", "Wposition"), "Wposition");
  EXPECT_PRED2(has, fault("}\nMOTION", "\nMOTION"), "not closed");
  EXPECT_PRED2(has, fault("Frames: 2", "Frames: 3"), "frame 2");
  EXPECT_PRED2(has, fault("Frames: 2", "Frames: 999999999999"), "999999999999 frames");
  EXPECT_PRED2(has, fault(".04", "0"), "frame time");
  EXPECT_PRED2(has, fault("5.50", "5,50"), "5,50");
  EXPECT_PRED2(has, fault("5.50", "nan"), "nan");
}

TEST(BvhExport, Damaged_texts_end_in_a_file_or_a_named_error) {
  ASSERT_TRUE(read_bvh(k_small));
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    auto file = read_bvh(damaged(k_small, {.alphabet = "{}0-9.e \nJOINTendSite"}, seed));
    refused += !file && !file.error().what.empty();
  }
  EXPECT_GT(refused, 500);
  const std::string whole = k_small.substr(0, k_small.size() - 4);  // the last number is what ends it
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) EXPECT_FALSE(read_bvh(whole.substr(0, size))) << size;
}

TEST(BvhExport, Refuses_changes_that_a_bvh_cannot_hold) {
  ScratchFolder scratch;
  ASSERT_TRUE(write_text_durably(scratch / "small.bvh", k_small));
  const Character character = load_character(scratch / "small.bvh", {}, {}).value().character;
  const auto refused = [&](int node, ChannelPath path, int width) {
    const ChangedChannel change{
        node, path, {KeyInterpolation::k_linear, width, {0}, std::vector<double>(at(width), 0.5)}};
    auto text = export_bvh(scratch / "small.bvh", character, 0, {&change, 1});
    return text ? std::string("no fault") : text.error().text();
  };
  EXPECT_NE(refused(0, ChannelPath::k_scale, 3).find("cannot be scaled"), std::string::npos);
  EXPECT_NE(refused(1, ChannelPath::k_translation, 3).find("joint \"b\""), std::string::npos);
  EXPECT_NE(refused(7, ChannelPath::k_rotation, 4).find("node 7"), std::string::npos);
  const ChangedChannel up{0, ChannelPath::k_translation, {KeyInterpolation::k_linear, 3, {0}, {0, 2, 0}}};
  std::string expected = k_small;
  expected.replace(expected.find("1e0"), 3, "2.000000");
  EXPECT_EQ(export_bvh(scratch / "small.bvh", character, 0, {&up, 1}).value(), expected);
}

TEST(BvhExport, Euler_angles_turn_back_into_the_rotation_and_stay_near) {
  for (const std::array<int, 3> axes : {std::array{2, 0, 1}, {2, 1, 0}, {0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {1, 2, 0}})
    for (int k = 0; k < 200; ++k) {
      const Vec3 angles(0.07 * k - 7, 1.5 * std::sin(0.3 * k), 0.05 * k);
      const auto turned = [&](const Vec3& v) {
        Quat q = Quat::Identity();
        for (int i = 0; i < 3; ++i) q = q * Quat(Eigen::AngleAxisd(v[i], Vec3::Unit(axes[at(i)])));
        return q;
      };
      const Vec3 found = euler_angles(turned(angles), axes, angles + Vec3(0.1, -0.1, 0.1));
      EXPECT_LT(turned(found).angularDistance(turned(angles)), 1e-7);
      EXPECT_LT((found - angles).norm(), 1e-7);
    }
}

}  // namespace
}  // namespace ft::test
