// `check` and the preview measure strain from the lengths that the bake had at rest: those of the flat pattern where a
// cloth is cut from one, however its panels were laid out.
#include <gtest/gtest.h>

#include "baker/judge/judge_caches.h"
#include "baker/record/manifest.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

constexpr double k_laid_out = 1.5;  ///< lengths of the placed mesh in those of the pattern

/// The sheet beside the box, whose pattern is shorter than it lies there. Scaled by pattern_scale = 0.1.
Mesh sheet_with_pattern() {
  Mesh out = FakeScene::sheet();
  for (const Vec3& p : out.positions) out.uvs.emplace_back(10 / k_laid_out * p.z(), 10 / k_laid_out * p.y());
  out.face_uvs = out.face_vertices;
  return out;
}

TEST(CheckStrain, Check_and_manifest_agree_on_a_cloth_that_is_cut_from_its_pattern) {
  FakeScene scene;
  scene.write_garment(sheet_with_pattern());
  scene.write_shot(3, "rest = \"pattern\"\npattern_scale = 0.1\npins = [{ vertices = \"0-2\" }]");
  BakeServices services = scene.services();
  services.make_solver = make_group_solver;
  Progress silent;
  const BakeResult baked = bake(scene.options(), services, silent);
  ASSERT_EQ(baked.exit_code, 0) << text(baked);

  const auto manifest = read_manifest(scene.folder().path);
  ASSERT_TRUE(manifest) << manifest.error().text();
  EXPECT_EQ(manifest->systems.at(0).pattern_scale, 0.1);
  const auto judged = judge_caches(scene.folder().path);
  ASSERT_TRUE(judged) << judged.error().text();
  const std::size_t preroll = manifest->frames.size() - judged->frames.size();
  for (std::size_t i = 0; i < judged->frames.size(); ++i) {
    const FrameReport &theirs = manifest->frames[preroll + i], &ours = judged->frames[i];
    EXPECT_NEAR(ours.strain_max, theirs.strain_max, 1e-5);  // caches hold floats
    EXPECT_NEAR(ours.strain_mean, theirs.strain_mean, 1e-5);
  }
}

TEST(CheckStrain, A_cloth_as_it_lies_has_its_lengths_from_the_mesh) {
  FakeScene scene;
  scene.write_garment(sheet_with_pattern());
  scene.write_shot(1, "rest = \"mesh\"");
  ASSERT_EQ(scene.run().exit_code, 0);
  EXPECT_EQ(scene.manifest_text().find("pattern_scale\": 0"), std::string::npos);
  const auto judged = judge_caches(scene.folder().path);
  ASSERT_TRUE(judged) << judged.error().text();
  EXPECT_LT(judged->frames.at(0).strain_max, 0.05);
}

TEST(CheckStrain, A_pattern_that_is_gone_from_the_folder_is_named) {
  FakeScene scene;
  scene.write_garment(sheet_with_pattern());
  scene.write_shot(1, "rest = \"pattern\"\npattern_scale = 0.1");
  ASSERT_EQ(scene.run().exit_code, 0);
  scene.write_garment(FakeScene::sheet());
  std::filesystem::copy_file(scene.file("sheet.obj"), scene.folder().path / "sheet.obj",
                             std::filesystem::copy_options::overwrite_existing);
  const auto judged = judge_caches(scene.folder().path);
  ASSERT_FALSE(judged);
  EXPECT_NE(judged.error().text().find("sheet.obj: has no vt"), std::string::npos) << judged.error().text();
}

}  // namespace
}  // namespace ft::test
