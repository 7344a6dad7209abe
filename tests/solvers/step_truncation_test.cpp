// What lies very near each other is not thrown past each other by an iteration.
#include "solvers/cloth/solve/step_truncation.h"

#include "tests/solvers/strips.h"

namespace ft {
namespace {

constexpr double k_near = 1e-4;  ///< m; the edges are 20 mm long

/// A strip whose first triangle has a vertex very near a corner, and two others one very near the middle of an edge: at
/// the border, and where other cloth lies beyond.
struct NearVertices {
  std::unique_ptr<ClothModel> model;
  int corner, twin, top, inner_top;
  Edge base, inner_base;
  std::vector<Vec3> all, direction;

  NearVertices() {
    ClothGarment garment = strip("strip", 0, 0);
    std::vector<Vec3> points = garment.mesh.positions;
    std::vector<Triangle> triangles = triangulate(garment.mesh);
    const auto insert = [&](std::size_t triangle, const Vec3& from) {
      const auto [a, b, c] = triangles[triangle];
      const int added = static_cast<int>(points.size());
      const Vec3 middle = (points[at(a)] + points[at(b)] + points[at(c)]) / 3;
      points.push_back(from + k_near * (middle - from).normalized());
      triangles[triangle] = {a, b, added};
      triangles.insert(triangles.end(), {{b, c, added}, {c, a, added}});
      return added;
    };
    const std::vector<Triangle> whole = triangles;
    const auto is_at_border = [&](const Edge& e) {
      return std::ranges::count_if(whole, [&](const Triangle& t) {
               return std::ranges::count(t, e[0]) + std::ranges::count(t, e[1]) == 2;
             }) == 1;
    };
    const auto edge_of = [&](std::size_t triangle, bool border) {
      const Triangle& t = whole[triangle];
      for (std::size_t k = 0; k < 3; ++k)
        if (const Edge e{t[k], t[(k + 1) % 3]}; is_at_border(e) == border) return e;
      ADD_FAILURE();
      return Edge{};
    };
    const std::size_t last = triangles.size() - 1, middle = triangles.size() / 2;
    corner = triangles[0][0], base = edge_of(last, true), inner_base = edge_of(middle, false);
    twin = insert(0, points[at(corner)]);
    top = insert(last, 0.5 * (points[at(base[0])] + points[at(base[1])]));
    inner_top = insert(middle, 0.5 * (points[at(inner_base[0])] + points[at(inner_base[1])]));
    garment.mesh = make_triangle_mesh("strip", points, triangles);
    model = model_of(in_vacuum({garment}));
    all = points;
    for (const Vec3& p : points) direction.push_back(Vec3(2e-3, 1e-3, 0) + 0.1 * Vec3(p.y(), 0, p.x()));
  }
  /// The direction after damp_relative_motion(), with one vertex's made longer by 5 mm.
  std::vector<Vec3> calmed(int vertex) const {
    std::vector<Vec3> out = direction;
    if (vertex >= 0) out[at(vertex)] += Vec3(3e-3, 0, 4e-3);
    StepTruncation(*model).damp_relative_motion(all, out);
    return out;
  }
  static Vec3 middle_of(const Edge& edge, const std::vector<Vec3>& d) {
    return 0.5 * (d[at(edge[0])] + d[at(edge[1])]);
  }
};

TEST(StepTruncation, Leaves_alone_what_moves_together) {
  const NearVertices scene;
  const std::vector<Vec3> calmed = scene.calmed(-1);
  for (std::size_t i = 0; i < calmed.size(); ++i) EXPECT_EQ(calmed[i], scene.direction[i]) << i;
}

TEST(StepTruncation, Slows_a_cluster_about_its_mean) {
  const NearVertices scene;
  const std::vector<Vec3> calmed = scene.calmed(scene.twin);
  const Vec3 &corner = calmed[at(scene.corner)], &twin = calmed[at(scene.twin)];
  EXPECT_NEAR((twin - corner).norm(), 0.5 * k_near, 1e-9);
  const Vec3 wanted = 0.5 * (scene.direction[at(scene.corner)] + scene.direction[at(scene.twin)] + Vec3(3e-3, 0, 4e-3));
  EXPECT_LT((0.5 * (corner + twin) - wanted).norm(), 1e-12);
}

TEST(StepTruncation, Slows_the_vertex_of_a_cap_against_the_base_and_not_the_base) {
  const NearVertices scene;
  const std::vector<Vec3> calmed = scene.calmed(scene.top);
  const Vec3 of_base = NearVertices::middle_of(scene.base, calmed);
  EXPECT_EQ(of_base, NearVertices::middle_of(scene.base, scene.direction));
  EXPECT_GT((calmed[at(scene.top)] - of_base).norm(), 0.4 * k_near);
  EXPECT_LT((calmed[at(scene.top)] - of_base).norm(), 0.6 * k_near);
}

TEST(StepTruncation, Leaves_alone_the_vertex_of_a_cap_that_elasticity_goes_round) {
  const NearVertices scene;
  const auto is_flipped = [&](int vertex) {
    return std::ranges::count(scene.model->flipped_caps, vertex, &FlippedCap::vertex) == 1;
  };
  EXPECT_TRUE(is_flipped(scene.inner_top));
  EXPECT_FALSE(is_flipped(scene.top));
  EXPECT_EQ(scene.calmed(scene.inner_top)[at(scene.inner_top)],
            scene.direction[at(scene.inner_top)] + Vec3(3e-3, 0, 4e-3));
}

TEST(StepTruncation, Does_not_touch_other_vertices) {
  const NearVertices scene;
  const int other = 2 * k_columns + 3;
  EXPECT_EQ(scene.calmed(other)[at(other)], scene.direction[at(other)] + Vec3(3e-3, 0, 4e-3));
}

}  // namespace
}  // namespace ft
