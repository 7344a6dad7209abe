// An independent reader: an adjusted motion, written as GLB and as BVH, has its bones in Blender where they are here.
#include <array>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "baker/core/file.h"
#include "io/export/bvh_export.h"
#include "io/export/gltf_export.h"
#include "tests/io_export/moved.h"

namespace ft::test {
namespace {

std::map<std::string, double> run_blender(const std::filesystem::path& expected, const std::filesystem::path& file) {
  const auto script = std::filesystem::path(FT_SOURCE_DIR) / "tests/io_export/blender_check.py";
  const std::string command = "blender -b --factory-startup -t 1 --python-exit-code 1 --python " + script.string() +
                              " -- " + expected.string() + " " + file.string() + " 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  std::map<std::string, double> out;
  std::array<char, 4096> line;
  std::string all;
  while (pipe != nullptr && std::fgets(line.data(), line.size(), pipe) != nullptr) {
    all += line.data();
    std::array<char, 64> name;
    double value = 0;
    if (std::sscanf(line.data(), "BLENDER %63s %lf", name.data(), &value) == 2) out[name.data()] = value;
  }
  if (pipe == nullptr || ::pclose(pipe) != 0) ADD_FAILURE() << all;
  return out;
}

TEST(Blender, Has_the_bones_of_an_adjusted_motion_where_they_are_here_slow) {
  if (std::system("command -v blender > /dev/null") != 0) GTEST_SKIP() << "skipped: blender is not installed";
  const char* const has_numpy =
      "blender -b --factory-startup --python-exit-code 1 --python-expr 'import numpy' > /dev/null 2>&1";
  if (std::system(has_numpy) != 0) GTEST_SKIP() << "skipped: Blender's importers need python3-numpy, not installed";
  const auto root = assets_root();
  std::vector<ImportRequest> requests(2);
  requests[0].file = root / "characters/mh_adult_cmu_dressed/adult_cmu01.glb";
  requests[0].clip = "01_01_forward_jumps_turn";
  requests[1].file = root / "mocap/animateddrawings_cmu_jacks/jumping_jacks.bvh", requests[1].body = "capsules";
  for (const ImportRequest& request : requests) {
    FT_REQUIRE_FILE(request.file);
    SCOPED_TRACE(request.file.string());
    auto placed = place_character(request);
    ASSERT_TRUE(placed) << placed.error().text();
    MotionAdjustment adjustment = adjustment_of(*placed);
    adjustment.deviation = [](double time) {
      const double w = std::clamp(time - 0.5, 0.0, 1.0);
      if (w == 0) return RootDeviation{};
      return RootDeviation{w * Vec3(0.1, -0.1, 0.2), Quat(Eigen::AngleAxisd(0.4 * w, Vec3(0, 0.6, 0.8))),
                           Vec3(0, 1, 0)};
    };
    for (const LimbChain& chain : find_limbs(placed->character))
      adjustment.limbs.push_back({chain, {}, [](double, const Vec3& imported) { return LimbTarget{imported, 0.5}; }});
    auto motion = adjust_motion(placed->character, placed->clip, placed->placement, adjustment);
    ASSERT_TRUE(motion) << motion.error().text();
    const Character original = placed->character;
    ASSERT_TRUE(apply_changes(placed->character, placed->clip, motion->channels));

    ScratchFolder scratch;
    const bool glb = request.file.extension() == ".glb";
    if (glb) {
      auto bytes = export_glb(request.file, original, placed->clip, motion->channels);
      ASSERT_TRUE(bytes) << bytes.error().text();
      ASSERT_TRUE(write_file_durably(scratch / "moved.glb", *bytes));
    } else {
      auto text = export_bvh(request.file, original, placed->clip, motion->channels);
      ASSERT_TRUE(text) << text.error().text();
      ASSERT_TRUE(write_text_durably(scratch / "moved.bvh", *text));
      placed->placement = Mat4::Identity();  // Blender takes the file's units as they are
    }
    // Blender's glTF importer rounds times to frames of 1/30 s, its BVH importer counts frames.
    const double frame_time = glb ? 1.0 / 30 : placed->character.clips[at(placed->clip)].end / 124;
    auto made = bvh_from_character(placed->character, placed->clip, placed->placement, {0, frame_time, 61});
    ASSERT_TRUE(made) << made.error().text();
    ASSERT_TRUE(write_text_durably(scratch / "made.bvh", *made));

    nlohmann::json expected = {{"fps", 30}, {"clip", glb ? request.clip : ""}, {"joints", nlohmann::json::array()}};
    expected["frames"] = {0, 20, 40, 60};
    for (const int frame : {0, 20, 40, 60}) {
      const auto nodes = nodes_at(*placed, frame * frame_time);
      nlohmann::json joints = nlohmann::json::object();
      for (std::size_t n = 0; n < original.nodes.size(); ++n) {
        const Vec3 p = place_of(nodes[n]);
        if (!original.nodes[n].name.starts_with("EndSite")) joints[original.nodes[n].name] = {p.x(), p.y(), p.z()};
      }
      expected["joints"].push_back(std::move(joints));
    }
    ASSERT_TRUE(write_text_durably(scratch / "expected.json", expected.dump()));
    const double size = glb ? 1 : 17;  // the BVH's unit is 5.6 cm
    for (const char* name : {glb ? "moved.glb" : "moved.bvh", "made.bvh"}) {
      const auto seen = run_blender(scratch / "expected.json", scratch / name);
      ASSERT_TRUE(seen.contains("bones") && seen.contains("worst"));
      std::printf("%s: %g bones, %.2e off\n", name, seen.at("bones"), seen.at("worst"));
      EXPECT_GE(seen.at("bones"), 28);
      EXPECT_LT(seen.at("worst"), 5e-6 * size);
    }
  }
}

}  // namespace
}  // namespace ft::test
