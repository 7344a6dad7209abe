#include "collision/broad_phase/pair_view.h"

#include <gtest/gtest.h>

namespace ft {
namespace {

/// Two faces over five vertices, and three edges, one of each the collider's.
struct Features {
  std::vector<Triangle> cloth_faces{{0, 1, 2}}, collider_faces{{1, 2, 3}};
  std::vector<Edge> cloth{{0, 1}, {1, 3}}, collider{{4, 5}};
  PairList list{{{pair_key(3, 0), pair_key(4, 0), pair_key(4, 1)}, {pair_key(0, 1), pair_key(0, 2), pair_key(1, 2)}},
                {cloth_faces, collider_faces, cloth, collider}};
};

TEST(PairView, Places_in_a_list_are_its_stencils) {
  const Features f;
  const PairPlaces places{&f.list, {0, 2}, {1}};
  const PairView view(places);
  ASSERT_EQ(view.count(PairKind::k_vertex_face), 2u);
  ASSERT_EQ(view.count(PairKind::k_edge_edge), 1u);
  EXPECT_EQ(view.stencil(PairKind::k_vertex_face, 0), (Stencil{{3, 0, 1, 2}}));
  EXPECT_EQ(view.stencil(PairKind::k_vertex_face, 1), (Stencil{{4, 1, 2, 3}}));
  EXPECT_EQ(view.stencil(PairKind::k_edge_edge, 0), (Stencil{{0, 1, 4, 5}}));
}

TEST(PairView, Stencils_are_seen_as_they_are) {
  const ContactPairs pairs{{Stencil{{3, 0, 1, 2}}}, {Stencil{{0, 1, 4, 5}}, Stencil{{1, 3, 4, 5}}}};
  const PairView view(pairs);
  ASSERT_EQ(view.count(PairKind::k_vertex_face), 1u);
  ASSERT_EQ(view.count(PairKind::k_edge_edge), 2u);
  EXPECT_EQ(view.stencil(PairKind::k_vertex_face, 0), pairs.vertex_face[0]);
  EXPECT_EQ(view.stencil(PairKind::k_edge_edge, 1), pairs.edge_edge[1]);
}

TEST(PairView, Of_no_pairs_there_are_none) {
  const ContactPairs none;
  EXPECT_EQ(PairView(none).count(PairKind::k_vertex_face) + PairView(none).count(PairKind::k_edge_edge), 0u);
  const Features f;
  const PairPlaces nowhere{&f.list, {}, {}};
  EXPECT_EQ(PairView(nowhere).count(PairKind::k_vertex_face) + PairView(nowhere).count(PairKind::k_edge_edge), 0u);
}

}  // namespace
}  // namespace ft
