// Features of the two surfaces of a pair search, numbered: faces and edges by their lexicographic rank, so that sorted
// numbers are sorted stencils; and for every triangle the features it stands for (its own vertices and edges), so that
// every feature is owned exactly once. Boxes of vertices beside; those of edges and faces are joined where they are
// looked at, which costs less than to keep them. For fcl_pair_finder.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "baker/core/mesh.h"
#include "collision/contact_pairs.h"

namespace ft {

static_assert(sizeof(VertexBox) == 6 * sizeof(float));

/// A box in registers, for joins and tests without branches: the outcome of a test is not predictable.
struct BoxLanes {
#ifdef __SSE__
  __m128 lo, hi;  ///< the fourth lane holds anything
  static BoxLanes load(const VertexBox& box) {
    const __m128 z_hi = _mm_loadu_ps(&box.lo[2]);  // and hi, which lies right behind lo
    return {_mm_loadu_ps(&box.lo[0]), _mm_shuffle_ps(z_hi, z_hi, _MM_SHUFFLE(0, 3, 2, 1))};
  }
  BoxLanes join(const BoxLanes& b) const {
    return {_mm_min_ps(lo, b.lo), _mm_max_ps(hi, b.hi)};
  }
  /// Smaller by `by` on every side.
  BoxLanes shrunk(float by) const {
    const __m128 m = _mm_set1_ps(by);
    return {_mm_add_ps(lo, m), _mm_sub_ps(hi, m)};
  }
  bool overlaps(const BoxLanes& b) const {
    return (_mm_movemask_ps(_mm_and_ps(_mm_cmple_ps(lo, b.hi), _mm_cmple_ps(b.lo, hi))) & 7) == 7;
  }
  void store(VertexBox& box) const {
    const __m128 z = _mm_shuffle_ps(lo, lo, _MM_SHUFFLE(2, 2, 2, 2));
    _mm_storeu_ps(&box.lo[0], lo);
    _mm_storeu_ps(&box.lo[2], _mm_move_ss(_mm_shuffle_ps(hi, hi, _MM_SHUFFLE(2, 1, 0, 3)), z));
  }
#else
  VertexBox box;
  static BoxLanes load(const VertexBox& b) {
    return {b};
  }
  BoxLanes join(const BoxLanes& b) const {
    BoxLanes out = *this;
    out.box.include(b.box);
    return out;
  }
  BoxLanes shrunk(float by) const {
    BoxLanes out = *this;
    for (std::size_t k = 0; k < 3; ++k) out.box.lo[k] += by, out.box.hi[k] -= by;
    return out;
  }
  bool overlaps(const BoxLanes& b) const {
    bool all = true;
    for (std::size_t k = 0; k < 3; ++k) all = all & (box.lo[k] <= b.box.hi[k]) & (b.box.lo[k] <= box.hi[k]);
    return all;
  }
  void store(VertexBox& out) const {
    out = box;
  }
#endif
};

/// A triangle as the search sees it.
struct PairElement {
  Triangle v;                       ///< its own vertices come first
  int face = 0;                     ///< rank of the face; -1 for a cord, or an earlier triangle again
  std::array<int, 3> owned_edge{};  ///< by rank; the first owned_edge_count are meant
  std::int8_t owned_vertex_count = 0, owned_edge_count = 0;
};

struct PairFeatures {
  int vertex_count = 0;
  std::vector<Triangle> faces;               ///< by rank
  std::vector<Edge> edges;                   ///< by rank
  std::vector<PairElement> cloth, collider;  ///< in the order of the triangles, until there are trees over them

  /// Of one search. What has an inverted box is nowhere: (infinity, -infinity), and what has a vertex that is nowhere
  /// is so too.
  std::vector<VertexBox> vertex_boxes;
  bool all_present = true;  ///< no vertex is nowhere

  PairFeatures(int cloth_vertex_count, std::span<const Triangle> cloth_triangles, int collider_vertex_count,
               std::span<const Triangle> collider_triangles);
  /// changed: per vertex; the boxes of the others stay as they are. Empty: all.
  void set_boxes(std::span<const VertexBox> boxes, std::span<const char> changed);
  bool present(int v) const { return all_present || vertex_boxes[at(v)].lo[0] <= vertex_boxes[at(v)].hi[0]; }
  BoxLanes box(int v) const { return BoxLanes::load(vertex_boxes[at(v)]); }
  /// Joins the vertices that are somewhere: an element without its third vertex may still own an edge.
  BoxLanes box(const PairElement& e) const { return box(e.v[0]).join(box(e.v[1])).join(box(e.v[2])); }
};

}  // namespace ft
