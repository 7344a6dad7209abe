// What is told of a character: by `info FILE`, the dry run and the progress.
#include "baker/plan/plan_text.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "baker/plan/primary_mass.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

TEST(CharacterLines, Say_what_the_file_has_and_what_of_it_is_used) {
  CharacterInfo info;
  info.format = "FBX";
  info.contents = {{"animation layers", 3, "used"}, {"constraints", 2, "not used: there is no solver for them"}};
  const std::vector<std::string> lines = character_lines(info);
  EXPECT_EQ(std::ranges::count(lines, "  3 animation layers: used"), 1);
  EXPECT_EQ(std::ranges::count(lines, "  2 constraints: not used: there is no solver for them"), 1);
}

TEST(PrimaryMass, Of_an_open_body_is_that_with_lids_and_a_note_says_so) {
  std::vector<Vec3> x;
  std::vector<Triangle> t;
  make_sphere(0.25, 32, 64, x, t);
  Surface surface;
  surface.part_of_vertex.assign(x.size(), 0), surface.parts = {{"ball", -1, 1}};
  surface.triangles = t;
  const auto still = [](double, std::span<Vec3>) {};
  const PrimaryMass whole = primary_mass({}, ScriptedBody(surface, x, 0, still));
  EXPECT_EQ(whole.note(), "");
  std::erase_if(surface.triangles, [&](const Triangle& f) {
    return std::ranges::any_of(f, [&](int v) { return std::abs(x[at(v)].y()) > 0.235; });
  });
  const PrimaryMass open = primary_mass({}, ScriptedBody(surface, x, 0, still));
  EXPECT_NEAR(open.kilograms, whole.kilograms, 0.02 * whole.kilograms);
  EXPECT_NE(open.note().find("its surface is open"), std::string::npos) << open.note();
  PrimarySpec spec;
  spec.mass = 3;
  EXPECT_EQ(primary_mass(spec, ScriptedBody(surface, x, 0, still)).note(), "");
}

}  // namespace
}  // namespace ft
