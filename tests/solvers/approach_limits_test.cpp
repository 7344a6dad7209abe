// Cloth that would meet something on its carried way keeps apart from it, at the cost of little motion.
#include "solvers/cloth/advance/approach_limits.h"

#include <gtest/gtest.h>

#include "collision/geometry/ccd_li2021.h"

namespace ft {
namespace {

constexpr double k_gap = 1e-4;   ///< m
constexpr double k_way = 4e-4;   ///< m
constexpr double k_edge = 5e-3;  ///< m

/// Edges across each other, each k_gap above the one before and crossing it in the middle: the first is the lowest.
/// Those of the cloth come first in the common numbering.
struct Edges {
  int cloth_edges = 0;
  std::vector<Vec3> x, cloth_motion, body_motion;

  void add(bool body, int layer, const Vec3& motion) {
    const Vec3 along = (layer % 2 == 0 ? Vec3(1, 0, 0) : Vec3(0, 0, 1)) * (0.5 * k_edge), middle(0, layer * k_gap, 0);
    x.push_back(middle - along), x.push_back(middle + along);
    (body ? body_motion : cloth_motion).insert((body ? body_motion : cloth_motion).end(), 2, motion);
    if (!body) ++cloth_edges;
  }
  std::vector<Vec3f> all() const {
    std::vector<Vec3f> d;
    for (const auto* motion : {&cloth_motion, &body_motion})
      for (const Vec3& m : *motion) d.push_back(m.cast<float>());
    return d;
  }
  static Stencil pair(int edge, int other) { return {{2 * edge, 2 * edge + 1, 2 * other, 2 * other + 1}}; }
  double time_of(const Stencil& s) const { return ccd_time(PairKind::k_edge_edge, gather(x, s), gather(all(), s)); }
};

TEST(ApproachLimits, An_edge_of_the_body_pushes_an_edge_of_the_cloth_before_it) {
  Edges edges;
  const Vec3 aside(1e-3, 0, 0);
  edges.add(false, 1, aside);
  edges.add(true, 0, {0, k_way, 0});
  const ContactPairs pairs{{}, {Edges::pair(0, 1)}};
  ASSERT_LT(edges.time_of(pairs.edge_edge[0]), 1);
  ApproachLimits limits;
  limits.add(pairs, edges.x, edges.all());
  limits.apply(edges.cloth_motion, edges.body_motion, {}, {});
  EXPECT_EQ(edges.time_of(pairs.edge_edge[0]), 1);
  for (const Vec3& d : edges.cloth_motion) {
    EXPECT_GT(d.y(), k_way - k_gap);
    EXPECT_LT(d.y(), k_way);
    EXPECT_NEAR(d.x(), aside.x(), 1e-15) << "it keeps what slides along the body";
  }
}

TEST(ApproachLimits, Layers_pass_on_what_they_are_given) {
  Edges edges;
  for (int layer = 1; layer <= 3; ++layer) edges.add(false, layer, Vec3::Zero());
  edges.add(true, 0, {0, k_way, 0});
  const ContactPairs pairs{{}, {Edges::pair(0, 3), Edges::pair(1, 0), Edges::pair(2, 1)}};
  ApproachLimits limits;
  limits.add(pairs, edges.x, edges.all());
  int rounds = 0;
  const auto free = [&] {
    return std::all_of(pairs.edge_edge.begin(), pairs.edge_edge.end(),
                       [&](const Stencil& s) { return edges.time_of(s) >= 1; });
  };
  for (; rounds < 8 && !free(); ++rounds) limits.apply(edges.cloth_motion, edges.body_motion, {}, {});
  EXPECT_TRUE(free());
  EXPECT_GT(rounds, 0);
}

TEST(ApproachLimits, What_has_room_keeps_its_motion) {
  Edges edges;
  edges.add(false, 1, {0, 0.9 * k_way, 0});
  edges.add(true, 0, {0, k_way, 0});
  const std::vector<Vec3> before = edges.cloth_motion;
  ApproachLimits limits;
  limits.add({{}, {Edges::pair(0, 1)}}, edges.x, edges.all());
  limits.apply(edges.cloth_motion, edges.body_motion, {}, {});
  EXPECT_EQ(edges.cloth_motion, before);
}

TEST(ApproachLimits, What_no_plane_separates_is_left_as_it_is) {
  Edges edges;
  edges.add(false, 1, Vec3::Zero());
  edges.add(true, 0, {0, k_way, 0});
  for (Vec3& x : edges.x) x.y() = 0;
  const std::vector<Vec3> before = edges.cloth_motion;
  ApproachLimits limits;
  limits.add({{}, {Edges::pair(0, 1)}}, edges.x, edges.all());
  limits.apply(edges.cloth_motion, edges.body_motion, {}, {});
  EXPECT_EQ(edges.cloth_motion, before);
}

}  // namespace
}  // namespace ft
