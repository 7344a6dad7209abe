// From a request to the two files, whatever the motion came in: both play what was asked.
#include "io/export/motion_files.h"

#include "baker/core/file.h"
#include "io/import/import_cache.h"
#include "tests/io_export/moved.h"

namespace ft::test {
namespace {

std::vector<ImportRequest> requests() {
  std::vector<ImportRequest> out;
  for (const MovedCase& c : moved_cases()) out.push_back(c.request);
  ImportRequest& kaykit = out.emplace_back();
  const auto folder = assets_root() / "characters/kaykit_mannequin";
  kaykit.file = folder / "manny_med_mod.gltf", kaykit.animation = folder / "Med_MovementBasic.glb";
  kaykit.clip = "Rig_Medium|Running_A";
  ImportRequest& bvh = out.emplace_back();
  bvh.file = assets_root() / "mocap/animateddrawings_cmu_jacks/jumping_jacks.bvh", bvh.body = "capsules";
  return out;
}

TEST(MotionFiles, Play_the_adjusted_motion_and_are_the_original_without_one) {
  for (const ImportRequest& request : requests()) {
    FT_REQUIRE_FILE(request.file);
    SCOPED_TRACE(request.file.string());
    auto placed = place_character(request);
    ASSERT_TRUE(placed) << placed.error().text();
    MotionAdjustment adjustment = adjustment_of(*placed);
    const Vec3 shift(0.05, -0.04, 0.1);
    adjustment.deviation = [&](double) { return RootDeviation{.displacement = shift}; };
    auto motion = adjust_motion(placed->character, placed->clip, placed->placement, adjustment);
    ASSERT_TRUE(motion) << motion.error().text();
    const BvhFrames frames{placed->playback.start, 1.0 / 30, 12};
    auto still = export_motion(request, *placed, {}, frames);
    auto files = export_motion(request, *placed, motion->channels, frames);
    ASSERT_TRUE(still) << still.error().text();
    ASSERT_TRUE(files) << files.error().text();

    const auto& source = request.animation.empty() ? request.file : request.animation;
    const auto ending = source.extension();
    EXPECT_TRUE(ending != ".glb" || still->glb == read_file(source).value());
    EXPECT_TRUE(ending != ".bvh" || still->bvh == read_text(source).value());
    EXPECT_EQ(files->notes.empty(), ending != ".fbx");

    ScratchFolder scratch;
    ASSERT_TRUE(write_file_durably(scratch / "moved.glb", files->glb));
    ASSERT_TRUE(write_text_durably(scratch / "moved.bvh", files->bvh));
    for (const char* name : {"moved.glb", "moved.bvh"}) {
      auto loaded = load_character(scratch / name, {}, {});
      ASSERT_TRUE(loaded) << loaded.error().text();
      PlacedCharacter again;
      again.character = std::move(loaded->character);
      again.clip = again.character.clips.size() == 1 ? 0 : placed->clip;
      const bool made = again.character.format != placed->character.format || ending == ".fbx";
      again.placement = made ? Mat4::Identity() : placed->placement;
      const bool from_zero = std::string_view(name) == "moved.bvh" && ending != ".bvh";
      double worst = 0;
      int compared = 0;
      for (int f = 0; f < frames.count; ++f) {
        const double time = f * frames.time;
        const auto x = nodes_at(*placed, frames.start + time),
                   y = nodes_at(again, from_zero ? time : frames.start + time);
        for (std::size_t n = 0; n < x.size(); ++n)
          for (std::size_t m = 0; m < y.size(); ++m) {
            const std::string& node = placed->character.nodes[n].name;
            bool below = false;  // what is beside the root stays where it is
            for (int up = static_cast<int>(n); up >= 0; up = placed->character.nodes[at(up)].parent)
              below = below || up == adjustment.roots[0];
            if (!below || again.character.nodes[m].name != node) continue;
            worst = std::max(worst, (place_of(y[m]) - place_of(x[n]) - shift).norm());
            ++compared;
          }
      }
      std::printf("%s %s: %.2e m off\n", request.file.filename().c_str(), name, worst);
      EXPECT_GE(compared, 15 * frames.count);
      EXPECT_LT(worst, std::string_view(name) == "moved.glb" ? 2e-6 : 1e-4);
    }
  }
}

}  // namespace
}  // namespace ft::test
