// The walk of fcl_pair_finder.cpp over box trees, down to pairs of features whose boxes overlap.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/node_patches.h"
#include "collision/pair_features.h"
#include "collision/pair_sort.h"

namespace ft {

/// A node of a tree over the triangles of one surface: a box, whose eighth lanes are the number of its first child.
/// Children lie next to each other, behind their parents; a negative one is a leaf, of element -1 - first_child().
class PairNode {
 public:
  explicit PairNode(int first_child) : box_(VertexBox::nowhere()) {
    box_.lo[7] = static_cast<std::int16_t>(first_child & 0xffff);
    box_.minus_hi[7] = static_cast<std::int16_t>(first_child >> 16);
  }
  int first_child() const {
    return static_cast<int>(static_cast<std::uint16_t>(box_.lo[7])) | static_cast<int>(box_.minus_hi[7]) << 16;
  }
  bool is_leaf() const { return box_.minus_hi[7] < 0; }
  std::size_t element() const { return static_cast<std::size_t>(-1 - first_child()); }
  BoxLanes box() const { return BoxLanes::load(box_); }
  void set_box(const BoxLanes& box) { box.store_axes(box_); }

 private:
  VertexBox box_;
};
static_assert(sizeof(PairNode) == 32);

/// Keys of feature pairs (pair_sort.h), by rank.
struct FoundPairs {
  std::vector<std::uint64_t> vertex_face, edge_edge;
};

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
  FoundPairs& out;

  BoxLanes smaller(const BoxLanes& box) const { return k_self ? box.shrunk(margin) : box; }

  [[gnu::always_inline]] bool meets(int a, int b) const {
    if (k_some && !(ma[a] | mb[b])) return false;
    if (!smaller(ta[a].box()).overlaps(tb[b].box())) return false;
    return !k_self || !patches || !patches->any_common(a, b, skipped);
  }

  /// All pairs below node n of ta, which is tb.
  void within(int n) const {
    const int i = ta[n].first_child();
    if (i < 0 || (k_some && !ma[n]) || (patches && patches->any(n, skipped))) return;
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
      meet(ea[na.element()], eb[nb.element()]);
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
  void meet(const PairElement& a, const PairElement& b) const {
    const BoxLanes box_a = smaller(features.box(a)), box_b = features.box(b);
    for (int i = 0; i < a.owned_vertex_count; ++i)
      vertex_against_face(a.v[at(i)], smaller(features.box(a.v[at(i)])), b, box_b);
    for (int i = 0; i < b.owned_vertex_count; ++i) vertex_against_face(b.v[at(i)], features.box(b.v[at(i)]), a, box_a);
    if (!want_edges || a.owned_edge_count == 0) return;
    for (int j = 0; j < b.owned_edge_count; ++j) {
      const int rb = b.owned_edge[at(j)];
      const Edge& vb = features.edges[at(rb)];
      const BoxLanes box = features.box(vb);
      if (!box.overlaps(box_a) || !features.present(vb[0]) || !features.present(vb[1])) continue;
      for (int i = 0; i < a.owned_edge_count; ++i) {
        const int ra = a.owned_edge[at(i)];
        const Edge& va = features.edges[at(ra)];
        if (!smaller(features.box(va)).overlaps(box)) continue;
        if (va[0] == vb[0] || va[0] == vb[1] || va[1] == vb[0] || va[1] == vb[1]) continue;
        if (!features.present(va[0]) || !features.present(va[1])) continue;
        if (k_some && !(changed[va[0]] | changed[va[1]] | changed[vb[0]] | changed[vb[1]])) continue;
        out.edge_edge.push_back(ra < rb ? pair_key(ra, rb) : pair_key(rb, ra));
      }
    }
  }

  void vertex_against_face(int v, const BoxLanes& box, const PairElement& f, const BoxLanes& of_face) const {
    if (!box.overlaps(of_face) || f.face < 0 || v == f.v[0] || v == f.v[1] || v == f.v[2]) return;
    if (!features.present(f.v[0]) || !features.present(f.v[1]) || !features.present(f.v[2])) return;
    if (k_some && !(changed[v] | changed[f.v[0]] | changed[f.v[1]] | changed[f.v[2]])) return;
    out.vertex_face.push_back(pair_key(v, f.face));
  }
};

}  // namespace ft
