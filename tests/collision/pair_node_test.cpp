// What a node of the pair search's trees says is below it.
#include "collision/broad_phase/pair_node.h"

#include <gtest/gtest.h>

namespace ft {
namespace {

TEST(PairNode, A_leaf_knows_its_elements_and_an_inner_node_its_children) {
  for (const int first : {0, 1, 7, 8, 32767, 32768, 65535, 65536, (1 << 28) - 1})
    for (int count = 1; count <= PairNode::k_most_elements; ++count) {
      const PairNode leaf = PairNode::leaf(first, count);
      EXPECT_TRUE(leaf.is_leaf());
      EXPECT_LT(leaf.first_child(), 0);
      EXPECT_EQ(leaf.first_element(), first);
      EXPECT_EQ(leaf.end_element(), first + count);
    }
  for (const int child : {1, 3, 32767, 32769, 65535, 65537, (1 << 30) + 1}) {
    const PairNode inner = PairNode::inner(child);
    EXPECT_FALSE(inner.is_leaf());
    EXPECT_EQ(inner.first_child(), child);
  }
}

TEST(PairNode, Its_box_changes_nothing_of_what_is_below) {
  const BoxFrame frame(Vec3::Constant(-1), Vec3::Constant(1));
  PairNode leaf = PairNode::leaf(123456, 3), inner = PairNode::inner(123457);
  for (const double place : {-0.7, 0.3, 5.0}) {
    const VertexBox box = frame.swept(Vec3::Constant(place), Vec3(0.1, 0.2, place), 0.01);
    for (PairNode* node : {&leaf, &inner}) {
      node->set_box(BoxLanes::load(box).join(node->box()));
      EXPECT_TRUE(node->box().overlaps(BoxLanes::load(box)));
    }
    EXPECT_EQ(leaf.first_element(), 123456);
    EXPECT_EQ(leaf.end_element(), 123459);
    EXPECT_EQ(inner.first_child(), 123457);
  }
}

}  // namespace
}  // namespace ft
