// Positions against an independent evaluator (three.js r166, reference/skinning): every stride-th vertex of every mesh
// at five times of a clip.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "baker/core/file.h"
#include "io/import/body/bind.h"
#include "io/import/body/skin.h"
#include "io/import/character/pose.h"
#include "io/import/import_cache.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

using Json = nlohmann::json;

struct Case {
  const char* reference;
  const char* folder;
};

class Skinning : public ::testing::TestWithParam<Case> {};

/// World positions of one mesh in the file's own vertex order, straight from the definition.
std::vector<Vec3> evaluate(const Character& c, const CharacterMesh& mesh, const std::vector<Mat4>& globals,
                           const double* morphs) {
  std::vector<Vec3> out;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3 base = mesh.positions[v];
    for (std::size_t k = 0; k < mesh.morphs.size(); ++k) base += morphs[k] * mesh.morphs[k].deltas[v];
    Vec3 sum = Vec3::Zero();
    const auto move = [&](const Mat4& m, double w) { sum += w * (m * base.homogeneous()).head<3>(); };
    if (mesh.bones.empty() || mesh.influence_start[v] == mesh.influence_start[v + 1])
      move(globals[static_cast<std::size_t>(mesh.node)], 1);
    else
      for (int k = mesh.influence_start[v]; k < mesh.influence_start[v + 1]; ++k) {
        const SkinBone& bone = mesh.bones[static_cast<std::size_t>(mesh.influence_bone[static_cast<std::size_t>(k)])];
        move(globals[static_cast<std::size_t>(bone.node)] * bone.inverse_bind,
             mesh.influence_weight[static_cast<std::size_t>(k)]);
      }
    out.push_back(sum);
  }
  (void)c;
  return out;
}

TEST_P(Skinning, Agrees_with_three_js_to_1e_minus_5_of_the_height) {
  const auto json_path = test::assets_root() / "reference" / "skinning" / (std::string(GetParam().reference) + ".json");
  FT_REQUIRE_FILE(json_path);
  const Json reference = Json::parse(*read_text(json_path));
  const auto file = test::assets_root() / "characters" / GetParam().folder / reference["file"].get<std::string>();
  FT_REQUIRE_FILE(file);
  auto loaded = load_character(file, {}, {});
  ASSERT_TRUE(loaded) << loaded.error().text();
  const Character& c = loaded->character;
  const std::string clip_name = reference["clip"];
  const Clip* clip = nullptr;
  for (const Clip& k : c.clips)
    if (k.name == clip_name) clip = &k;
  ASSERT_NE(clip, nullptr);
  EXPECT_NEAR(clip->end, reference["duration_s"].get<double>(), 1e-6);
  ASSERT_EQ(c.meshes.size(), reference["meshes"].size());

  const BindPose bind = find_bind_pose(c);
  std::vector<int> all;
  for (std::size_t m = 0; m < c.meshes.size(); ++m) all.push_back(static_cast<int>(m));
  std::vector<std::string> notes;
  const Skin skin = weld(c, all, notes);
  const ClipPose pose(c, clip), rest(c, nullptr);
  std::vector<Vec3> welded(skin.base.size());
  deform(skin, Mat4::Identity(), bind.globals, rest.rest_morphs(), welded);
  const double height = bounds(welded).size().y();
  const int stride = reference["stride"];

  double worst = 0, worst_welded = 0;
  for (std::size_t s = 0; s < 5; ++s) {
    const double time = reference["meshes"][0]["samples"][s]["time_s"];
    std::vector<Mat4> locals(c.nodes.size()), globals(c.nodes.size());
    std::vector<double> morphs(pose.rest_morphs().size());
    pose.sample(time, locals, morphs);
    globals_from_locals(c.nodes, locals, globals);
    std::vector<std::vector<Vec3>> mine;
    for (const CharacterMesh& mesh : c.meshes)
      mine.push_back(
          evaluate(c, mesh, globals, morphs.data() + pose.morph_start()[static_cast<std::size_t>(mesh.node)]));

    // Three's meshes come in another order: pair by vertex count and least distance.
    std::vector<char> taken(mine.size(), 0);
    for (const Json& theirs : reference["meshes"]) {
      const Json& sample = theirs["samples"][s];
      ASSERT_EQ(sample["time_s"].get<double>(), time);
      const std::vector<double> p = sample["positions"];
      double best = 1e300;
      std::size_t who = 0;
      for (std::size_t m = 0; m < mine.size(); ++m) {
        if (taken[m] || mine[m].size() != theirs["mesh_vertex_count"].get<std::size_t>()) continue;
        double far = 0;
        for (std::size_t k = 0; 3 * k + 2 < p.size(); ++k)
          far = std::max(
              far,
              (mine[m].at(k * static_cast<std::size_t>(stride)) - Vec3(p[3 * k], p[3 * k + 1], p[3 * k + 2])).norm());
        if (far < best) best = far, who = m;
      }
      ASSERT_LT(best, 1e300) << "no mesh of this size";
      taken[who] = 1;
      worst = std::max(worst, best);
    }

    // And what the trajectory walks, welded, is the same surface.
    deform(skin, Mat4::Identity(), globals, morphs, welded);
    for (std::size_t i = 0; i < welded.size(); ++i)
      worst_welded = std::max(
          worst_welded,
          (welded[i] -
           mine[static_cast<std::size_t>(skin.origins[i].mesh)][static_cast<std::size_t>(skin.origins[i].vertex)])
              .norm());
  }
  RecordProperty("worst_over_height", std::to_string(worst / height));
  std::printf("  %-40s %.2e of the height (%.3f)\n", GetParam().reference, worst / height, height);
  EXPECT_LT(worst, 1e-5 * height);
  EXPECT_LT(worst_welded, 1e-12 * height);
}

INSTANTIATE_TEST_SUITE_P(References, Skinning,
                         ::testing::Values(Case{"cesium_man", "cesium_man"}, Case{"horse_Rear", "m2m_horse"},
                                           Case{"horse_Run", "m2m_horse"},
                                           Case{"mh_adult_01_01_forward_jumps_turn", "mh_adult_cmu_dressed"},
                                           Case{"mh_adult_01_03_climb_hang_swing", "mh_adult_cmu_dressed"},
                                           Case{"quaternius_Dance_Loop", "quaternius_base_human"},
                                           Case{"quaternius_Jog_Fwd_Loop", "quaternius_base_human"},
                                           Case{"quaternius_Roll", "quaternius_base_human"},
                                           Case{"robot_Dance", "robot_expressive"},
                                           Case{"robot_WalkJump", "robot_expressive"}),
                         [](const auto& one) { return one.param.reference; });

}  // namespace
}  // namespace ft
