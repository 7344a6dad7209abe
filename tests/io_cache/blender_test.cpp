// An independent reader: Blender has a PC2 reader of its own and, where it is built with it, the public Alembic
// library. Debian's is not; a Blender from elsewhere that stands first in PATH is asked for both.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "baker/core/file.h"
#include "tests/support/assets.h"
#include "tests/support/cache_samples.h"

namespace ft::test {
namespace {

std::filesystem::path script(const char* name) {
  return std::filesystem::path(FT_SOURCE_DIR) / "tests/io_cache" / name;
}

/// What lines "BLENDER name value" say.
std::map<std::string, std::string> run_blender(const std::string& arguments) {
  std::map<std::string, std::string> out;
  FILE* pipe =
      ::popen(("blender -b --factory-startup -t 1 --python-exit-code 1 --python " + arguments + " 2>&1").c_str(), "r");
  std::array<char, 4096> line;
  std::string all;
  while (pipe != nullptr && std::fgets(line.data(), line.size(), pipe) != nullptr) {
    std::string text(line.data());
    all += text;
    if (!text.starts_with("BLENDER ")) continue;
    text = text.substr(8, text.find_last_not_of("\n") - 7);
    const auto space = text.find(' ');
    out[text.substr(0, space)] = text.substr(space + 1);
  }
  if (pipe == nullptr || ::pclose(pipe) != 0) ADD_FAILURE() << all;
  return out;
}

nlohmann::json points_json(const std::vector<std::vector<Vec3>>& frames) {
  nlohmann::json out = nlohmann::json::array();
  for (const auto& frame : frames) {
    nlohmann::json points = nlohmann::json::array();
    for (const Vec3& p : frame)
      points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    out.push_back(std::move(points));
  }
  return out;
}

nlohmann::json expectation(const CacheSample& s) {
  nlohmann::json j = {{"fps", s.info.fps}, {"first_frame", s.info.first_frame}};
  j["positions"] = points_json(s.positions);
  j["faces"] = j["uvs"] = nlohmann::json::array();
  const Mesh& m = s.info.mesh;
  std::size_t corner = 0;
  for (const int size : m.face_sizes) {
    nlohmann::json face = nlohmann::json::array(), uvs = nlohmann::json::array();
    for (int c = 0; c < size; ++c, ++corner) {
      face.push_back(m.face_vertices[corner]);
      const Vec2& uv = m.uvs[static_cast<std::size_t>(m.face_uvs[corner])];
      uvs.push_back({uv.x(), uv.y()});
    }
    j["faces"].push_back(face);
    j["uvs"].push_back(uvs);
  }
  return j;
}

TEST(Blender, Sees_in_alembic_and_pc2_what_was_baked_slow) {
  if (std::system("command -v blender > /dev/null") != 0) GTEST_SKIP() << "skipped: blender is not installed";
  ScratchFolder scratch;
  // Twice the announced frames, a resume in between: the layout that is hardest to read.
  CacheSample sample = waving_patch(6, 5, 12);
  for (auto& frame : sample.positions)
    for (Vec3& p : frame) p = p / 3.0 + Vec3(0.1, -2.7, 3.3);
  sample.info.frame_count = 6;
  const auto abc = scratch / "patch.abc", pc2 = scratch / "patch.pc2";
  for (const auto& path : {abc, pc2}) {
    const CacheFormat& format = *find_cache_format(path.extension().string().substr(1));
    ASSERT_TRUE(write_cache(format, path, sample, 9));
    ASSERT_TRUE(write_cache(format, path, sample, 12, 5));
  }
  ASSERT_TRUE(write_text_durably(scratch / "expected.json", expectation(sample).dump()));
  auto seen = run_blender(script("blender_check.py").string() + " -- " + (scratch / "expected.json").string() + " " +
                          abc.string() + " " + pc2.string());
  ASSERT_FALSE(seen["pc2"].empty());
  EXPECT_LE(std::stod(seen["pc2"]), 0);  // axes change places, nothing is rounded
  if (seen["has_alembic"] != "1") {
    std::puts("this Blender is built without Alembic (Debian's is): only PC2 was compared");
    return;
  }
  EXPECT_EQ(seen["meshes"], "1");
  EXPECT_EQ(seen["name"], "patch");
  EXPECT_EQ(seen["range"], "1001 1012");
  EXPECT_EQ(seen["faces"], "1");
  EXPECT_LE(std::stod(seen["abc"]), 1e-6);  // one rounding of coordinates up to 4 m
  EXPECT_LE(std::stod(seen["uvs"]), 1e-7);
}

}  // namespace
}  // namespace ft::test
