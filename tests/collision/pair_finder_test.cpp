// The pair finder against brute force over all features, on tame and untamed meshes: the same list, element for
// element.
#include "collision/broad_phase/pair_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>

#include "baker/core/parallel.h"
#include "tests/collision/grid.h"
#include "tests/collision/pair_scene.h"
#include "tests/support/assets.h"
#include "tests/support/numbered_pairs.h"
#include "tests/support/pair_brute_force.h"

namespace ft {
namespace {

const BoxFrame k_frame(Vec3::Constant(-1.5), Vec3::Constant(1.5));

using test::brute_force;
using test::Dice;
using Scene = test::PairScene;

/// A wavy n x n grid of quads, two triangles each, numbered from first.
void add_grid(int n, int first, double height, double wave, Dice& dice, std::vector<Vec3>& x,
              std::vector<Triangle>& triangles) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = i / (n - 1.0), v = j / (n - 1.0);
      x.emplace_back(u, height + wave * std::sin(7 * u + 3 * v) + 0.1 * wave * dice.uniform(), v);
    }
  test::add_grid_triangles(n, first, triangles);
}

Scene two_sheets(int n, double reach, std::uint64_t seed) {
  Dice dice(seed);
  Scene scene;
  std::vector<Vec3> x;
  add_grid(n, 0, 0.0, 0.05, dice, x, scene.cloth);
  scene.cloth_vertices = n * n;
  add_grid(n + 3, n * n, 0.02, -0.03, dice, x, scene.collider);
  scene.collider_vertices = (n + 3) * (n + 3);
  for (const Vec3& p : x) scene.boxes.push_back(k_frame.swept(p, p + dice.cube(0.3 * reach), reach));
  return scene;
}

/// Triangles between any vertices: shared by many, repeated, flat, with vertices named twice; boxes of all sizes.
Scene soup(std::uint64_t seed) {
  Dice dice(seed);
  Scene scene;
  scene.cloth_vertices = 3 + dice.below(20);
  scene.collider_vertices = 3 + dice.below(20);
  const auto fill = [&](int first, int count, std::vector<Triangle>& out) {
    const int triangles = dice.below(40);
    for (int k = 0; k < triangles; ++k) {
      Triangle t;
      for (int& v : t) v = first + dice.below(count);
      if (t[0] == t[1] && t[1] == t[2]) continue;
      out.push_back(t);
      if (dice.below(10) == 0) out.push_back(t);
    }
  };
  fill(0, scene.cloth_vertices, scene.cloth);
  fill(scene.cloth_vertices, scene.collider_vertices, scene.collider);
  for (int i = 0; i < scene.cloth_vertices + scene.collider_vertices; ++i) {
    const Vec3 p = dice.cube(1);
    VertexBox b = k_frame.swept(p, p + dice.cube(0.2), std::pow(10, dice.uniform(-3, -0.7)));
    const int odd = dice.below(12);
    if (odd <= 1) b = VertexBox::nowhere();
    scene.boxes.push_back(b);
  }
  return scene;
}

void expect_same(const ContactPairs& a, const ContactPairs& b) {
  EXPECT_EQ(a.vertex_face.size(), b.vertex_face.size());
  EXPECT_EQ(a.edge_edge.size(), b.edge_edge.size());
  EXPECT_TRUE(a.vertex_face == b.vertex_face);
  EXPECT_TRUE(a.edge_edge == b.edge_edge);
}

test::StencilFinder finder_of(const Scene& s) {
  return {s.cloth_vertices, s.cloth, s.collider_vertices, s.collider};
}

TEST(PairFinder, Finds_what_brute_force_finds_between_two_wavy_sheets) {
  for (const double reach : {0.001, 0.02, 0.08}) {
    const Scene scene = two_sheets(14, reach, 3);
    test::StencilFinder finder = finder_of(scene);
    for (const bool self : {false, true}) {
      ContactPairs found;
      finder.find(scene.boxes, self, found);
      const ContactPairs expected = brute_force(scene, self);
      expect_same(found, expected);
      if (reach > 0.01) {
        EXPECT_GT(expected.edge_edge.size(), 500u);
      }
    }
  }
}

/// All boxes of the cloth smaller by `by` on every side, and by some steps.
Scene with_smaller_cloth(Scene scene, double by, int steps) {
  BoxMargin margin = k_frame.margin(by);
  for (std::int16_t& m : margin) m = static_cast<std::int16_t>(m + steps);
  for (int v = 0; v < scene.cloth_vertices; ++v)
    for (std::size_t k = 0; k < k_box_axes; ++k) {
      scene.boxes[at(v)].lo[k] = static_cast<std::int16_t>(scene.boxes[at(v)].lo[k] + margin[k]);
      scene.boxes[at(v)].minus_hi[k] = static_cast<std::int16_t>(scene.boxes[at(v)].minus_hi[k] + margin[k]);
    }
  return scene;
}

TEST(PairFinder, A_margin_leaves_out_cloth_that_hardly_overlaps_cloth_and_nothing_else) {
  constexpr double k_margin = 0.02;
  const Scene scene = two_sheets(14, 0.04, 3);
  test::StencilFinder finder = finder_of(scene);
  finder.set_self_margin(k_frame.margin(k_margin));
  ContactPairs found, all;
  finder.find(scene.boxes, true, found);
  // The margin is taken off once a pair: half of it off each of two boxes is as much.
  const ContactPairs needed = brute_force(with_smaller_cloth(scene, 0.5 * k_margin, 1), true),
                     allowed = brute_force(with_smaller_cloth(scene, 0.48 * k_margin, 0), true);
  const auto of_cloth = [&](const Stencil& s) {
    return std::all_of(s.v.begin(), s.v.end(), [&](int v) { return v < scene.cloth_vertices; });
  };
  const auto expect_between = [&](const std::vector<Stencil>& few, const std::vector<Stencil>& some,
                                  const std::vector<Stencil>& many) {
    for (const Stencil& s : few) EXPECT_TRUE(std::binary_search(some.begin(), some.end(), s));
    for (const Stencil& s : some) EXPECT_TRUE(!of_cloth(s) || std::binary_search(many.begin(), many.end(), s));
    EXPECT_GT(few.size(), 200u);
  };
  expect_between(needed.vertex_face, found.vertex_face, allowed.vertex_face);
  expect_between(needed.edge_edge, found.edge_edge, allowed.edge_edge);
  all = brute_force(scene, true);
  EXPECT_LT(found.edge_edge.size(), 0.9 * static_cast<double>(all.edge_edge.size()));
  for (auto* pairs : {&all.vertex_face, &all.edge_edge, &found.vertex_face, &found.edge_edge})
    std::erase_if(*pairs, of_cloth);
  expect_same(found, all);  // cloth and collider
}

TEST(PairFinder, Finds_what_brute_force_finds_in_random_soups_of_triangles) {
  int pairs = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Scene scene = soup(seed);
    test::StencilFinder finder = finder_of(scene);
    ContactPairs found;
    for (int again = 0; again < 3; ++again) {
      const bool self = seed % 2 == 0 || again == 1;
      finder.find(scene.boxes, self, found);
      expect_same(found, brute_force(scene, self));
      pairs += static_cast<int>(found.edge_edge.size());
      if (HasFailure()) FAIL() << "seed " << seed << ", search " << again;
      scene.boxes =
          soup(seed * 7 + static_cast<std::uint64_t>(again) + 1000).boxes;  // moved elsewhere: refit, not rebuilt
      scene.boxes.resize(static_cast<std::size_t>(scene.cloth_vertices + scene.collider_vertices),
                         k_frame.swept({0, 0, 0}, {0.5, 0, 0}, 0.1));
    }
  }
  EXPECT_GT(pairs, 10000);
}

bool holds(const VertexBox& box, const Vec3& p) {
  for (std::size_t k = 0; k < k_box_axes; ++k)
    if (along_box_axis(k, p) < k_frame.lo(box, k) || along_box_axis(k, p) > k_frame.hi(box, k)) return false;
  return true;
}

TEST(PairFinder, Every_pair_that_can_meet_inside_its_boxes_is_listed) {
  Dice dice(21);
  const Scene scene = two_sheets(12, 0.03, 5);
  ContactPairs found;
  finder_of(scene).find(scene.boxes, true, found);
  std::vector<Vec3> x(scene.boxes.size());
  const auto inside = [&](int v) {
    const VertexBox& b = scene.boxes[static_cast<std::size_t>(v)];
    Vec3 p;
    do {
      for (int i = 0; i < 3; ++i) p[i] = dice.uniform(k_frame.lo(b, at(i)), k_frame.hi(b, at(i)));
    } while (!holds(b, p));
    return p;
  };
  for (int trial = 0; trial < 20; ++trial) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = inside(static_cast<int>(i));
    for (int v = 0; v < scene.cloth_vertices; ++v) {
      for (const Triangle& t : scene.collider) {
        const auto separates = [&](std::size_t k) {
          const auto along = [&](int w) { return along_box_axis(k, x[at(w)]); };
          const auto [lo, hi] = std::minmax({along(t[0]), along(t[1]), along(t[2])});
          return along(v) < lo || along(v) > hi;
        };
        bool apart = false;
        for (std::size_t k = 0; k < k_box_axes; ++k) apart = apart || separates(k);
        if (apart) continue;
        const Stencil wanted{{v, t[0], t[1], t[2]}};
        EXPECT_TRUE(std::binary_search(found.vertex_face.begin(), found.vertex_face.end(), wanted));
      }
    }
  }
}

TEST(PairFinder, Lists_are_sorted_single_and_equal_for_every_number_of_threads) {
  const Scene scene = two_sheets(45, 0.02, 9);
  ContactPairs first;
  finder_of(scene).find(scene.boxes, true, first);
  EXPECT_GT(first.vertex_face.size(), 30000u);
  PairList keys;
  test::StencilFinder keyed = finder_of(scene);
  keyed.PairFinder::find(scene.boxes, true, keys);
  for (const auto* list : {&keys.vertex_face, &keys.edge_edge}) {
    EXPECT_TRUE(std::is_sorted(list->begin(), list->end()));
    EXPECT_EQ(std::adjacent_find(list->begin(), list->end()), list->end());
  }
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    test::StencilFinder finder = finder_of(scene);
    for (int again = 0; again < 2; ++again) {
      ContactPairs found;
      finder.find(scene.boxes, true, found);
      expect_same(found, first);
    }
  }
}

TEST(PairFinder, A_search_does_not_depend_on_the_searches_before_it) {
  const Scene scene = two_sheets(20, 0.02, 4);
  std::vector<VertexBox> elsewhere;
  Dice dice(6);
  for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
    const Vec3 p = dice.cube(3);
    elsewhere.push_back(k_frame.swept(p, p, 0.1));
  }
  test::StencilFinder seasoned = finder_of(scene), fresh = finder_of(scene);
  ContactPairs a, b;
  seasoned.find(elsewhere, true, a);
  seasoned.find(scene.boxes, true, a);
  fresh.find(scene.boxes, true, b);
  expect_same(a, b);
}

TEST(PairFinder, A_search_without_edges_finds_the_same_vertices_and_faces) {
  const Scene scene = two_sheets(20, 0.02, 4);
  test::StencilFinder finder = finder_of(scene);
  ContactPairs all, some;
  for (const bool self : {true, false}) {
    finder.find_vertex_face(scene.boxes, self, some);
    finder.find(scene.boxes, self, all);
    EXPECT_TRUE(some.vertex_face == all.vertex_face);
    EXPECT_TRUE(some.edge_edge.empty());
    finder.find_vertex_face(scene.boxes, self, all);
    expect_same(some, all);
  }
}

TEST(PairFinder, A_search_for_changed_vertices_finds_their_pairs_and_no_others) {
  Scene scene = two_sheets(20, 0.02, 4);
  test::StencilFinder finder = finder_of(scene);
  ContactPairs all, some;
  finder.find(scene.boxes, true, all);  // the trees are of before
  Dice dice(11);
  for (const int every : {1, 3, 40, 1000000}) {
    std::vector<char> changed(scene.boxes.size(), 0);
    for (std::size_t i = 0; i < changed.size(); i += at(every)) {
      if (i == 0 && every > 1000) continue;
      changed[i] = 1;
      const Vec3 p = 0.05 * dice.cube(1);
      scene.boxes[i].include(k_frame.swept(p, p, 0.01));
    }
    for (const bool self : {true, false}) {
      finder.find_changed(scene.boxes, self, changed, some);
      finder.find(scene.boxes, self, all);
      const auto is_not_changed = [&](const Stencil& s) {
        return std::none_of(s.v.begin(), s.v.end(), [&](int v) { return changed[at(v)] != 0; });
      };
      std::erase_if(all.vertex_face, is_not_changed);
      std::erase_if(all.edge_edge, is_not_changed);
      expect_same(some, all);
      EXPECT_EQ(all.edge_edge.empty(), every > 1000);
    }
  }
}

TEST(PairFinder, Edges_of_a_face_with_a_vertex_that_is_nowhere_still_count) {
  // Two collider triangles share the edge 3-4; vertex 5 of the first is nowhere.
  Scene scene{3, 4, {{0, 1, 2}}, {{3, 4, 5}, {4, 3, 6}}, {}};
  for (int i = 0; i < 7; ++i) scene.boxes.push_back(k_frame.swept({0, 0, 0}, {1, 1, 1}, 0));
  scene.boxes[5] = VertexBox::nowhere();
  ContactPairs found;
  finder_of(scene).find(scene.boxes, false, found);
  expect_same(found, brute_force(scene, false));
  EXPECT_EQ(found.vertex_face.size(), 6u);  // three cloth vertices on one face; vertices 3, 4, 6 on the cloth's
  EXPECT_EQ(found.edge_edge.size(), 9u);
}

/// Positions and triangles of an OBJ file, vertices numbered from first.
void read_obj(const std::filesystem::path& path, int first, std::vector<Vec3>& x, std::vector<Triangle>& triangles) {
  std::ifstream in(path);
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string kind, corner;
    words >> kind;
    if (kind == "v") {
      Vec3& p = x.emplace_back();
      words >> p[0] >> p[1] >> p[2];
    } else if (kind == "f") {
      std::vector<int> face;
      while (words >> corner) face.push_back(first + std::stoi(corner) - 1);
      for (std::size_t i = 2; i < face.size(); ++i) triangles.push_back({face[0], face[i - 1], face[i]});
    }
  }
}

TEST(PairFinder, Finds_what_brute_force_finds_between_a_skirt_and_a_mannequin_slow) {
  const auto garments = test::assets_root() / "garments";
  const auto skirt = garments / "cipc_skirts/skirt4K.obj";
  const auto body = garments / "cipc_mannequin_rumba/body_frame0_yup.obj";
  FT_REQUIRE_FILE(skirt);
  FT_REQUIRE_FILE(body);
  Scene scene;
  std::vector<Vec3> x;
  read_obj(skirt, 0, x, scene.cloth);
  scene.cloth_vertices = static_cast<int>(x.size());
  read_obj(body, scene.cloth_vertices, x, scene.collider);
  scene.collider_vertices = static_cast<int>(x.size()) - scene.cloth_vertices;
  ASSERT_GT(scene.cloth.size(), 5000u);
  ASSERT_GT(scene.collider.size(), 5000u);
  // The skirt is drawn flat, as a ring: it is folded down around hips and thighs, so close that the two cut each other.
  for (int i = 0; i < scene.cloth_vertices; ++i) {
    Vec3& p = x[static_cast<std::size_t>(i)];
    const double r = std::hypot(p.x(), p.z()), folded = (0.09 + 0.1 * r) / r;
    p = Vec3(folded * p.x(), 0.2 * p.y() + 0.95 - r, folded * p.z());
  }
  Dice dice(17);
  for (const Vec3& p : x) scene.boxes.push_back(k_frame.swept(p, p + dice.cube(0.004), 0.003));
  ContactPairs found;
  finder_of(scene).find(scene.boxes, true, found);
  const ContactPairs expected = brute_force(scene, true);
  expect_same(found, expected);
  const auto with_collider = std::count_if(found.vertex_face.begin(), found.vertex_face.end(), [&](const Stencil& s) {
    return (s.v[0] < scene.cloth_vertices) != (s.v[1] < scene.cloth_vertices);
  });
  EXPECT_GT(with_collider, 1000);
  std::printf("  %zu + %zu triangles, %zu vertex-face, %zu edge-edge\n", scene.cloth.size(), scene.collider.size(),
              found.vertex_face.size(), found.edge_edge.size());
}

TEST(PairFinder, Nothing_meets_nothing) {
  ContactPairs found;
  found.vertex_face.resize(3);
  const std::vector<VertexBox> three(3, k_frame.swept({0, 0, 0}, {1, 1, 1}, 0));
  test::StencilFinder(0, {}, 0, {}).find({}, true, found);
  EXPECT_TRUE(found.vertex_face.empty() && found.edge_edge.empty());
  const std::vector<Triangle> one{{0, 1, 2}};
  test::StencilFinder(3, one, 0, {}).find(three, true, found);
  EXPECT_TRUE(found.vertex_face.empty() && found.edge_edge.empty());
  test::StencilFinder(0, {}, 3, one).find(three, true, found);
  EXPECT_TRUE(found.vertex_face.empty() && found.edge_edge.empty());
}

TEST(PairFinder, A_cord_meets_faces_with_its_ends_and_edges_with_its_length) {
  const std::vector<Triangle> cord{{0, 1, 1}}, face{{2, 3, 4}};
  ContactPairs found;
  test::StencilFinder(2, cord, 3, face)
      .find(std::vector<VertexBox>(5, k_frame.swept({0, 0, 0}, {1, 1, 1}, 0)), true, found);
  EXPECT_EQ(found.vertex_face, (std::vector<Stencil>{{{0, 2, 3, 4}}, {{1, 2, 3, 4}}}));
  EXPECT_EQ(found.edge_edge, (std::vector<Stencil>{{{0, 1, 2, 3}}, {{0, 1, 2, 4}}, {{0, 1, 3, 4}}}));
}

}  // namespace
}  // namespace ft
