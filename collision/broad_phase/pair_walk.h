// The walk of pair_finder.cpp over box trees, down to pairs of features whose boxes overlap.
#pragma once

#include <bit>
#include <span>

#include "collision/broad_phase/node_patches.h"
#include "collision/broad_phase/pair_features.h"
#include "collision/broad_phase/pair_list.h"
#include "collision/broad_phase/pair_node.h"

namespace ft::inline collision {

/// Walks two trees, or one against itself, and writes down the feature pairs of leaves that overlap. k_some: only those
/// with a changed vertex. k_self: both trees are one, and there may be a margin and patches.
template <bool k_some, bool k_self>
struct PairWalk {
  const PairFeatures& features;
  const PairNode *ta, *tb;
  const char *ma, *mb;  ///< marks of the trees
  const char* changed;  ///< per vertex
  const PairElement *ea, *eb;
  bool want_edges;
  BoxMargin margin;            ///< boxes of ta are taken for smaller by so much
  const NodePatches* patches;  ///< of ta and tb; null: none
  std::span<const char> skipped;
  PairKeys& out;

  BoxLanes smaller(const BoxLanes& box) const { return k_self ? box.shrunk(margin) : box; }

  [[gnu::always_inline]] bool meets(int a, int b) const {
    if (k_some && !(ma[a] | mb[b])) return false;
    if (!smaller(ta[a].box()).overlaps(tb[b].box())) return false;
    return !k_self || !patches || !patches->any_common(a, b, skipped);
  }

  /// All pairs below node n of ta, which is tb.
  void within(int n) const {
    if ((k_some && !ma[n]) || (patches && patches->any(n, skipped))) return;
    const int i = ta[n].first_child();
    if (i < 0) {
      for (int a = ta[n].first_element(); a < ta[n].end_element(); ++a)
        for (int b = a + 1; b < ta[n].end_element(); ++b)
          element_against_element(a, smaller(features.box(ea[a])), b, features.box(eb[b]));
      return;
    }
    within(i);
    within(i + 1);
    if (meets(i, i + 1)) between(i, i + 1);
  }

  /// a and b overlap. Both sides descend together: four tests in a row cost less than two visits.
  void between(int a, int b) const {
    const PairNode& na = ta[a];
    const PairNode& nb = tb[b];
    const int i = na.first_child(), j = nb.first_child();
    if (i < 0 && j < 0) {
      leaf_against_leaf(na, nb);
    } else if (j < 0) {
      if (meets(i, b)) between(i, b);
      if (meets(i + 1, b)) between(i + 1, b);
    } else if (i < 0) {
      if (meets(a, j)) between(a, j);
      if (meets(a, j + 1)) between(a, j + 1);
    } else {
      if (meets(i, j)) between(i, j);
      if (meets(i, j + 1)) between(i, j + 1);
      if (meets(i + 1, j)) between(i + 1, j);
      if (meets(i + 1, j + 1)) between(i + 1, j + 1);
    }
  }

  void leaf_against_leaf(const PairNode& a, const PairNode& b) const {
    const int first = b.first_element(), count = b.end_element() - first;
    BoxLanes boxes[PairNode::k_most_elements];
    for (int j = 0; j < count; ++j) boxes[j] = features.box(eb[first + j]);
    for (int i = a.first_element(); i < a.end_element(); ++i) {
      const BoxLanes box = smaller(features.box(ea[i]));
      for (int j = 0; j < count; ++j) element_against_element(i, box, first + j, boxes[j]);
    }
  }

  [[gnu::always_inline]] void element_against_element(int a, const BoxLanes& box_a, int b,
                                                      const BoxLanes& box_b) const {
    if (!box_a.overlaps(box_b)) return;
    if (k_self && patches && patches->any_common_of_elements(a, b, skipped)) return;
    meet(ea[a], box_a, eb[b], box_b);
  }

  /// The feature pairs that a pair of triangles is responsible for.
  [[gnu::always_inline]] void meet(const PairElement& a, const BoxLanes& box_a, const PairElement& b,
                                   const BoxLanes& box_b) const {
    const Triangle &va = features.corners(a), &vb = features.corners(b);
    for (unsigned own = a.owned_vertices; own != 0; own &= own - 1) {
      const int v = va[at(std::countr_zero(own))];
      if (b.has_face) vertex_against_face(v, smaller(features.box(v)), b.triangle, vb, box_b);
    }
    for (unsigned own = b.owned_vertices; own != 0; own &= own - 1) {
      const int v = vb[at(std::countr_zero(own))];
      if (a.has_face) vertex_against_face(v, features.box(v), a.triangle, va, box_a);
    }
    meet_edges(a, box_a, b);
  }

  void meet_edges(const PairElement& a, const BoxLanes& box_a, const PairElement& b) const {
    if (!want_edges || a.owned_edge_count == 0) return;
    for (int j = 0; j < b.owned_edge_count; ++j) {
      const int rb = b.owned_edge[at(j)];
      const Edge& vb = features.edge(rb);
      const BoxLanes box = features.box(vb);
      if (!box.overlaps(box_a) || !features.present(vb[0]) || !features.present(vb[1])) continue;
      for (int i = 0; i < a.owned_edge_count; ++i) {
        const int ra = a.owned_edge[at(i)];
        const Edge& va = features.edge(ra);
        if (!smaller(features.box(va)).overlaps(box)) continue;
        if (va[0] == vb[0] || va[0] == vb[1] || va[1] == vb[0] || va[1] == vb[1]) continue;
        if (!features.present(va[0]) || !features.present(va[1])) continue;
        if (k_some && !(changed[va[0]] | changed[va[1]] | changed[vb[0]] | changed[vb[1]])) continue;
        out.edge_edge.push_back(ra < rb ? pair_key(ra, rb) : pair_key(rb, ra));
      }
    }
  }

  void vertex_against_face(int v, const BoxLanes& box, int face, const Triangle& f, const BoxLanes& of_face) const {
    if (!box.overlaps(of_face) || v == f[0] || v == f[1] || v == f[2]) return;
    if (!features.present(f[0]) || !features.present(f[1]) || !features.present(f[2])) return;
    if (k_some && !(changed[v] | changed[f[0]] | changed[f[1]] | changed[f[2]])) return;
    out.vertex_face.push_back(pair_key(v, face));
  }
};

}  // namespace ft::inline collision
