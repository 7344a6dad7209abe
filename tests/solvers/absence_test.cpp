// What cloth does not meet, decided at the end of a frame.
#include "solvers/cloth/model/absence.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "solvers/cloth/model/cloth_model.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

/// A sheet on a large ball, which it wears, and a small ball a metre above, which it does not.
class CaughtScene {
 public:
  explicit CaughtScene(bool fixed = false) {
    Surface surface;
    std::vector<Vec3> points;
    make_sphere(0.3, 16, 24, points, surface.triangles);
    const std::size_t large = points.size();
    make_sphere(0.05, 12, 16, points, surface.triangles);
    for (std::size_t i = large; i < points.size(); ++i) points[i].y() += k_height;
    surface.parts = {{"trunk", -1, 1.0}, {"hand", -1, 0.001}};
    surface.parts[1].fixed = fixed;
    surface.part_of_vertex.resize(points.size(), 1);
    std::fill_n(surface.part_of_vertex.begin(), large, 0);
    ClothSetup setup;
    setup.garments.resize(1);
    setup.garments[0].name = "sheet";
    setup.garments[0].mesh = make_sheet(0.4, 10, 0.305);
    setup.garments[0].fabric = *find_fabric("cotton");
    setup.primary = std::make_shared<ScriptedBody>(surface, points, 0, [points](double, std::span<Vec3> x) {
      std::copy(points.begin(), points.end(), x.begin());
    });
    auto built = build_cloth_model(std::move(setup));
    EXPECT_TRUE(built) << built.error().text();
    model = std::move(*built);
    std::vector<Vec3> drawn;
    model->collider->drawn(0, drawn);
    model->collider->feasible(0, drawn, body);
    motion.x.assign(model->contact.rest.begin(), model->contact.rest.end());
    motion.absent = model->absence.at_start(std::vector<char>(body.size(), 0));
  }

  /// Of a part's vertices, how many are absent, in shares.
  double absent(int part) {
    CheckedSurface collider(model->collider->triangles());
    collider.move(body);
    model->absence.let_go_of_what_caught(*model, collider, motion);
    double all = 0, gone = 0;
    for (std::size_t b = 0; b < body.size(); ++b) {
      if (model->collider->part_of_vertex()[b] != part) continue;
      ++all;
      gone += motion.absent[model->absence.place(0, static_cast<int>(b))];
    }
    return gone / all;
  }

  static constexpr double k_height = 1;
  std::unique_ptr<ClothModel> model;
  std::vector<Vec3> body;
  ClothMotion motion;
};

TEST(Absence, A_part_in_which_cloth_is_caught_goes_as_a_whole) {
  CaughtScene scene;
  EXPECT_EQ(scene.absent(1), 0);
  scene.motion.x[0] = Vec3(0, CaughtScene::k_height + 0.053, 0);  // stretched to it, by far
  EXPECT_EQ(scene.absent(1), 1);
  EXPECT_EQ(scene.absent(0), 0) << "what is worn stays";
}

TEST(Absence, A_set_that_stands_still_is_never_let_go_as_a_whole) {
  CaughtScene scene(true);
  scene.motion.x[0] = Vec3(0, CaughtScene::k_height + 0.053, 0);
  EXPECT_EQ(scene.absent(1), 0) << "cloth that is caught on the ground would fall through it";
}

TEST(Absence, What_is_stretched_elsewhere_has_not_been_caught) {
  CaughtScene scene;
  scene.motion.x[0] = Vec3(0, CaughtScene::k_height + 0.08, 0);  // 3 cm from it
  EXPECT_EQ(scene.absent(1), 0);
}

TEST(Absence, What_only_lies_on_a_part_has_not_been_caught) {
  CaughtScene scene;
  for (Vec3& x : scene.motion.x) x += Vec3(0, CaughtScene::k_height + 0.053 - 0.305, 0);
  EXPECT_EQ(scene.absent(1), 0);
}

/// Lets go of a vertex that is still there and borders on what is not; returns how many go.
int grow_hole(CaughtScene& scene, std::span<const char> deep) {
  const auto is_absent = [&](int b) { return scene.motion.absent[scene.model->absence.place(0, b)] != 0; };
  for (const Edge& e : unique_edges(scene.model->collider->triangles()))
    if (is_absent(e[0]) != is_absent(e[1])) {
      const int rim = is_absent(e[0]) ? e[1] : e[0];
      return scene.model->absence.let_go(*scene.model, 0, std::span(&rim, 1), scene.body, deep, scene.motion.absent);
    }
  return 0;
}

TEST(Absence, A_hole_that_has_to_grow_does_so_by_its_half) {
  CaughtScene scene;
  const std::vector<char> deep(scene.body.size(), 0);
  const int first = 100;
  int hole = scene.model->absence.let_go(*scene.model, 0, std::span(&first, 1), scene.body, deep, scene.motion.absent);
  EXPECT_LT(hole, 10) << "at first what blocks and what is next to it";
  for (int k = 0; k < 4; ++k) {
    const int more = grow_hole(scene, deep);
    EXPECT_GE(more, hole / 2) << k;
    EXPECT_LE(more, hole / 2 + 10) << "not more than it takes: " << k;
    hole += more;
  }
}

TEST(Absence, A_hole_next_to_what_was_planned_is_no_larger_for_it) {
  CaughtScene scene;
  std::vector<char> deep(scene.body.size(), 0);
  for (std::size_t b = 0; b < deep.size(); ++b)
    deep[b] = scene.model->collider->part_of_vertex()[b] == 0 && scene.body[b].y() < 0 ? 1 : 0;
  scene.motion.absent = scene.model->absence.at_start(deep);
  EXPECT_LT(grow_hole(scene, deep), 10);
}

}  // namespace
}  // namespace ft
