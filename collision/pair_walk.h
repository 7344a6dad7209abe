// The walk of fcl_pair_finder.cpp over box trees, down to pairs of features whose boxes overlap.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/node_patches.h"
#include "collision/pair_features.h"
#include "collision/pair_sort.h"

namespace ft {

/// A node of a tree over the triangles of one surface. Children lie next to each other, behind their parents.
struct alignas(32) PairNode {
  VertexBox box;
  int first_child;  ///< negative: a leaf, of element -1 - first_child
};
inline bool is_leaf(const PairNode& node) {
  return node.first_child < 0;
}
inline std::size_t leaf_element(const PairNode& node) {
  return static_cast<std::size_t>(-1 - node.first_child);
}
inline BoxLanes lanes(const PairNode& node) {
  return BoxLanes::load(node.box);
}
inline bool overlap(const PairNode& a, const PairNode& b) {
  return lanes(a).overlaps(lanes(b));
}

/// Keys of feature pairs (pair_sort.h), by rank.
struct FoundPairs {
  std::vector<std::uint64_t> vertex_face, edge_edge;
};

/// Walks two trees, or one against itself, and writes down the feature pairs of leaves that overlap. k_some: only those
/// with a changed vertex.
template <bool k_some>
struct PairWalk {
  const PairFeatures& features;
  const PairNode *ta, *tb;
  const char *ma, *mb;  ///< marks of the trees
  const char* changed;  ///< per vertex
  const PairElement *ea, *eb;
  bool want_edges;
  float margin;                ///< boxes of ta are taken for smaller by so much
  const NodePatches* patches;  ///< of ta and tb; null: none
  std::span<const char> skipped;
  FoundPairs& out;

  BoxLanes of_a(const PairNode& node) const { return lanes(node).shrunk(margin); }

  bool meets(int a, int b) const {
    if (k_some && !(ma[a] | mb[b])) return false;
    return of_a(ta[a]).overlaps(lanes(tb[b])) && !(patches && patches->any_common(a, b, skipped));
  }

  /// All pairs below node n of ta, which is tb.
  void within(int n) const {
    const int i = ta[n].first_child;
    if (i < 0 || (k_some && !ma[n]) || (patches && patches->any(n, skipped))) return;
    within(i);
    within(i + 1);
    if (meets(i, i + 1)) between(i, i + 1);
  }

  /// a and b overlap. Both sides descend together: four tests in a row cost less than two visits.
  void between(int a, int b) const {
    const PairNode& na = ta[a];
    const PairNode& nb = tb[b];
    const int i = na.first_child, j = nb.first_child;
    if (i < 0 && j < 0) {
      meet(ea[leaf_element(na)], of_a(na), eb[leaf_element(nb)], lanes(nb));
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

  /// The feature pairs that a pair of triangles is responsible for.
  void meet(const PairElement& a, const BoxLanes& box_a, const PairElement& b, const BoxLanes& box_b) const {
    vertices_against_face(a, b, box_b, margin);
    vertices_against_face(b, a, box_a, 0);
    if (!want_edges || a.owned_edge_count == 0) return;
    for (int j = 0; j < b.owned_edge_count; ++j) {
      const int rb = b.owned_edge[at(j)];
      const Edge& vb = features.edges[at(rb)];
      const BoxLanes box = features.box(vb[0]).join(features.box(vb[1]));
      if (!box.overlaps(box_a) || !features.present(vb[0]) || !features.present(vb[1])) continue;
      for (int i = 0; i < a.owned_edge_count; ++i) {
        const int ra = a.owned_edge[at(i)];
        const Edge& va = features.edges[at(ra)];
        if (!box.overlaps(features.box(va[0]).join(features.box(va[1])).shrunk(margin))) continue;
        if (va[0] == vb[0] || va[0] == vb[1] || va[1] == vb[0] || va[1] == vb[1]) continue;
        if (!features.present(va[0]) || !features.present(va[1])) continue;
        if (k_some && !(changed[va[0]] | changed[va[1]] | changed[vb[0]] | changed[vb[1]])) continue;
        out.edge_edge.push_back(ra < rb ? pair_key(ra, rb) : pair_key(rb, ra));
      }
    }
  }

  /// Of the two, one has the margin taken off: p's vertices, or the face's box already.
  void vertices_against_face(const PairElement& p, const PairElement& f, const BoxLanes& face_box,
                             float own_margin) const {
    if (f.face < 0) return;
    for (int i = 0; i < p.owned_vertex_count; ++i) {
      const int v = p.v[at(i)];
      if (!features.box(v).shrunk(own_margin).overlaps(face_box) || v == f.v[0] || v == f.v[1] || v == f.v[2]) continue;
      if (!features.present(f.v[0]) || !features.present(f.v[1]) || !features.present(f.v[2])) continue;
      if (k_some && !(changed[v] | changed[f.v[0]] | changed[f.v[1]] | changed[f.v[2]])) continue;
      out.vertex_face.push_back(pair_key(v, f.face));
    }
  }
};

}  // namespace ft
