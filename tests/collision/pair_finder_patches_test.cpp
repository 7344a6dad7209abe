// What the pair finder leaves out: pairs inside patches that are skipped.
#include <gtest/gtest.h>

#include <algorithm>

#include "collision/broad_phase/pair_finder.h"
#include "tests/collision/grid.h"
#include "tests/collision/pair_scene.h"
#include "tests/support/numbered_pairs.h"
#include "tests/support/pair_brute_force.h"

namespace ft {
namespace {

const BoxFrame k_frame(Vec3::Constant(-1.5), Vec3::Constant(1.5));

/// n x n vertices with boxes that reach over their neighbours.
test::PairScene wavy_sheet(int n, double reach, test::Dice& dice) {
  test::PairScene scene;
  scene.cloth_vertices = n * n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = i / (n - 1.0), v = j / (n - 1.0);
      const Vec3 p(u, 0.05 * std::sin(7 * u + 3 * v), v);
      scene.boxes.push_back(k_frame.swept(p, p + dice.cube(0.3 * reach), reach));
    }
  test::add_grid_triangles(n, 0, scene.cloth);
  return scene;
}

void expect_same(const ContactPairs& a, const ContactPairs& b) {
  EXPECT_TRUE(a.vertex_face == b.vertex_face);
  EXPECT_TRUE(a.edge_edge == b.edge_edge);
}

TEST(PairFinderPatches, Pairs_inside_a_skipped_one_are_left_out_and_no_others) {
  test::Dice dice(9);
  const test::PairScene scene = wavy_sheet(14, 0.04, dice);
  const int triangles = static_cast<int>(scene.cloth.size());
  std::vector<std::vector<int>> rows(60);
  AscendingRows members;
  std::vector<char> skipped;
  for (std::vector<int>& row : rows) {
    const int first = dice.below(triangles), last = std::min(triangles, first + dice.below(60));
    for (int t = first; t < last; ++t) row.push_back(t);
    members.push_back(row);
    skipped.push_back(dice.below(3) != 0 ? 1 : 0);
  }
  // A feature that several triangles have is looked at in one of them: what is left out has to be inside the patch,
  // what is found must not be inside it with all of its triangles.
  const auto inside_by = [&](int patch, const Stencil& s, bool vertex_face, auto&& quantifier) {
    const std::vector<int>& row = rows[at(patch)];
    const auto within = [&](std::span<const int> feature) {
      std::vector<int> with;
      for (int t = 0; t < triangles; ++t)
        if (std::all_of(feature.begin(), feature.end(), [&](int v) {
              return std::find(scene.cloth[at(t)].begin(), scene.cloth[at(t)].end(), v) != scene.cloth[at(t)].end();
            }))
          with.push_back(t);
      return !with.empty() && quantifier(with, [&](int t) { return std::binary_search(row.begin(), row.end(), t); });
    };
    const std::span<const int> v(s.v);
    const std::size_t split = vertex_face ? 1 : 2;
    return within(v.first(split)) && within(v.subspan(split));
  };
  const auto any = [](const std::vector<int>& with, auto&& in) { return std::any_of(with.begin(), with.end(), in); };
  const auto all = [](const std::vector<int>& with, auto&& in) { return std::all_of(with.begin(), with.end(), in); };
  const auto inside = [&](const Stencil& s, bool vertex_face, auto&& quantifier) {
    for (int patch = 0; patch < 60; ++patch)
      if (skipped[at(patch)] != 0 && inside_by(patch, s, vertex_face, quantifier)) return true;
    return false;
  };

  test::StencilFinder finder(scene.cloth_vertices, scene.cloth, 0, {});
  finder.set_patches(members);
  ContactPairs found;
  finder.find(scene.boxes, true, found);
  const ContactPairs every = test::brute_force(scene, true);
  expect_same(found, every);
  std::vector<char> changed(scene.boxes.size(), 1);
  for (const bool some : {false, true}) {
    some ? finder.find_changed(scene.boxes, true, changed, found, skipped)
         : finder.find(scene.boxes, true, found, skipped);
    const auto compare = [&](const std::vector<Stencil>& few, const std::vector<Stencil>& many, bool vertex_face) {
      EXPECT_LT(few.size(), many.size());
      EXPECT_TRUE(std::includes(many.begin(), many.end(), few.begin(), few.end()));
      for (const Stencil& s : many) {
        const bool listed = std::binary_search(few.begin(), few.end(), s);
        EXPECT_TRUE(listed || inside(s, vertex_face, any));
        EXPECT_FALSE(listed && inside(s, vertex_face, all));
      }
    };
    compare(found.vertex_face, every.vertex_face, true);
    compare(found.edge_edge, every.edge_edge, false);
  }
  finder.find(scene.boxes, true, found);  // nothing stays from the search before
  expect_same(found, every);
}

TEST(PairFinderPatches, Of_triangles_that_share_no_vertex_exactly_the_pairs_inside_are_left_out) {
  test::Dice dice(31);
  int left_out = 0, kept = 0;
  for (const int triangles : {2, 3, 8, 9, 20, 60})  // one leaf, and many
    for (int again = 0; again < 10; ++again) {
      test::PairScene scene;
      scene.cloth_vertices = 3 * triangles;
      for (int t = 0; t < triangles; ++t) {
        scene.cloth.push_back({3 * t, 3 * t + 1, 3 * t + 2});
        const Vec3 middle = dice.cube(0.5);
        for (int i = 0; i < 3; ++i) {
          const Vec3 p = middle + dice.cube(0.2);
          scene.boxes.push_back(k_frame.swept(p, p, 0.1));
        }
      }
      std::vector<std::vector<int>> rows(4);
      AscendingRows members;
      std::vector<char> skipped;
      for (int patch = 0; patch < 4; ++patch) {
        std::vector<int>& row = rows[at(patch)];
        for (int t = 0; t < triangles; ++t)
          if (dice.below(3) == 0) row.push_back(t);
        members.push_back(row);
        skipped.push_back(patch != 1 ? 1 : 0);
      }
      const auto is_inside = [&](const Stencil& s) {
        for (int patch = 0; patch < members.row_count(); ++patch) {
          const std::vector<int>& row = rows[at(patch)];
          if (skipped[at(patch)] != 0 && std::binary_search(row.begin(), row.end(), s.v[0] / 3) &&
              std::binary_search(row.begin(), row.end(), s.v[3] / 3))
            return true;
        }
        return false;
      };
      test::StencilFinder finder(scene.cloth_vertices, scene.cloth, 0, {});
      finder.set_patches(members);
      ContactPairs found, wanted = test::brute_force(scene, true);
      finder.find(scene.boxes, true, found, skipped);
      left_out += static_cast<int>(std::erase_if(wanted.vertex_face, is_inside));
      left_out += static_cast<int>(std::erase_if(wanted.edge_edge, is_inside));
      kept += static_cast<int>(wanted.edge_edge.size());
      expect_same(found, wanted);
    }
  EXPECT_GT(left_out, 1000);
  EXPECT_GT(kept, 1000);
}

}  // namespace
}  // namespace ft
