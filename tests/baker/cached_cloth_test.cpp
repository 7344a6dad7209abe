// The cache of an open cloth as a primary, beside whoever wears it: it is a sheet, and nobody is inside it.
#include <gtest/gtest.h>

#include <fstream>

#include "baker/record/manifest.h"
#include "io/import/import.h"
#include "io/shot/mesh_file.h"
#include "tests/baker/fake_bake.h"
#include "tests/support/scripted_body.h"

namespace ft::test {
namespace {

/// A ball in a tube without ends, which is what a robe is; a scarf lies on the ball.
class CachedCloth : public testing::Test {
 protected:
  CachedCloth() {
    std::vector<Vec3> x;
    std::vector<Triangle> t;
    constexpr int k_rings = 20, k_segments = 40;
    for (int r = 0; r <= k_rings; ++r)
      for (int s = 0; s < k_segments; ++s) {
        const double a = 2 * std::numbers::pi * s / k_segments;
        x.emplace_back(0.2 * std::cos(a), 0.05 * r - 0.5, 0.2 * std::sin(a));
      }
    const auto v = [&](int r, int s) { return r * k_segments + s % k_segments; };
    for (int r = 0; r < k_rings; ++r)
      for (int s = 0; s < k_segments; ++s) {
        t.push_back({v(r, s), v(r + 1, s), v(r, s + 1)});
        t.push_back({v(r + 1, s), v(r + 1, s + 1), v(r, s + 1)});
      }
    EXPECT_TRUE(write_obj(folder_ / "robe.obj", make_triangle_mesh("robe", x, t)).ok());
    EXPECT_TRUE(write_obj(folder_ / "scarf.obj", make_sheet(0.2, 8, 0.16)).ok());
  }
  /// Of all frames: the most of each.
  FrameReport baked(const std::string& robe_lines, const std::string& name) {
    std::ofstream(folder_ / "shot.toml") << "[shot]\nframes = \"1-4\"\nfps = 24\npreroll = 2\n"
                                            "[primary.ball]\nshape = \"sphere\"\nradius = 0.15\n"
                                            "velocity = [0.02, 0.01, 0]\n"
                                            "[primary.robe]\nfile = \"robe.obj\"\n"
                                         << robe_lines
                                         << "\n[cloth.scarf]\nmesh = \"scarf.obj\"\non = \"ball\"\n"
                                            "[cache]\nformats = [\"pc2\"]\n";
    BakeOptions options;
    options.shot_file = folder_ / "shot.toml";
    options.folder = folder_ / name;
    Progress silent;
    const BakeResult done = bake(options, {import_primary, make_group_solver}, silent);
    EXPECT_EQ(done.exit_code, 0) << text(done);
    const auto manifest = read_manifest(options.folder);
    EXPECT_TRUE(manifest) << manifest.error().text();
    FrameReport out;
    for (const FrameReport& frame : manifest->frames) {
      out.deepest_drawn = std::max(out.deepest_drawn, frame.deepest_drawn);
      out.crossings_body = std::max(out.crossings_body, frame.crossings_body);
    }
    return out;
  }
  ScratchFolder folder_;
};

TEST_F(CachedCloth, No_cloth_on_its_wearer_is_inside_it) {
  const FrameReport sheet = baked("", "sheet");
  EXPECT_EQ(sheet.deepest_drawn, 0);
  EXPECT_EQ(sheet.crossings_body, 0);
  // As a body with an inside it swallows both. What is absent then, tests/collision/sheet_test.cpp has.
  EXPECT_GT(baked("surface = \"solid\"", "solid").deepest_drawn, 0.01);
}

}  // namespace
}  // namespace ft::test
