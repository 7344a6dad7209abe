// A node of the box trees of pair_finder.cpp: 32 bytes with its box. Leaves hold several triangles, whose boxes are
// joined from those of their vertices where two leaves meet: that takes no more time than nodes all the way down, and a
// fifth of their room. (Sheets of 4,000 and 40,000 vertices on a body: 4, 6 and 8 triangles to a leaf are equally fast,
// 2 and 3 a little slower.)
#pragma once

#include <cstdint>

#include "collision/broad_phase/vertex_box.h"

namespace ft::inline collision {

/// Children lie next to each other, behind their parents; the elements of a leaf in one row. The eighth lanes of the
/// box say what is below: the number of the first child; or, below 0, the first element and how many there are.
class PairNode {
 public:
  static constexpr int k_most_elements = 8;  ///< of a leaf

  static PairNode inner(int first_child) { return PairNode(first_child); }
  /// first_element is below 2^28.
  static PairNode leaf(int first_element, int element_count) {
    return PairNode(-1 - (first_element * k_most_elements + (element_count - 1)));
  }

  bool is_leaf() const { return box_.minus_hi[7] < 0; }
  /// Negative for a leaf.
  int first_child() const {
    return static_cast<int>(static_cast<std::uint16_t>(box_.lo[7])) | static_cast<int>(box_.minus_hi[7]) << 16;
  }
  int first_element() const { return (-1 - first_child()) / k_most_elements; }
  int end_element() const { return first_element() + (-1 - first_child()) % k_most_elements + 1; }
  BoxLanes box() const { return BoxLanes::load(box_); }
  void set_box(const BoxLanes& box) { box.store_axes(box_); }

 private:
  explicit PairNode(int below) : box_(VertexBox::nowhere()) {
    box_.lo[7] = static_cast<std::int16_t>(below & 0xffff);
    box_.minus_hi[7] = static_cast<std::int16_t>(below >> 16);
  }

  VertexBox box_;
};
static_assert(sizeof(PairNode) == 32);

}  // namespace ft::inline collision
