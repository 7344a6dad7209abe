// Features of the two surfaces of a pair search, numbered: faces and edges by their lexicographic rank, so that sorted
// numbers are sorted stencils; and for every triangle the features it stands for (its own vertices and edges), so that
// every feature is owned exactly once. Boxes of all of them beside. For fcl_pair_finder.cpp.
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

/// lo and hi are three floats each, one after the other. No branches: the outcome is not predictable.
inline bool boxes_overlap(const float* a, const float* b) {
#ifdef __SSE__
  // Four lanes from lo, four up to hi; the fourth lane of the comparison is not looked at.
  const __m128 a_lo = _mm_loadu_ps(a), b_lo = _mm_loadu_ps(b);
  const __m128 a_z_hi = _mm_loadu_ps(a + 2), b_z_hi = _mm_loadu_ps(b + 2);
  const __m128 a_hi = _mm_shuffle_ps(a_z_hi, a_z_hi, _MM_SHUFFLE(0, 3, 2, 1));
  const __m128 b_hi = _mm_shuffle_ps(b_z_hi, b_z_hi, _MM_SHUFFLE(0, 3, 2, 1));
  return (_mm_movemask_ps(_mm_and_ps(_mm_cmple_ps(a_lo, b_hi), _mm_cmple_ps(b_lo, a_hi))) & 7) == 7;
#else
  return (a[0] <= b[3]) & (b[0] <= a[3]) & (a[1] <= b[4]) & (b[1] <= a[4]) & (a[2] <= b[5]) & (b[2] <= a[5]);
#endif
}
static_assert(sizeof(VertexBox) == 6 * sizeof(float));
inline bool overlap(const VertexBox& a, const VertexBox& b) {
  return boxes_overlap(a.lo.data(), b.lo.data());
}

/// A triangle as the search sees it.
struct PairElement {
  Triangle v;
  int face = 0;                                     ///< rank of the face; -1 for a repetition of an earlier triangle
  std::array<int, 3> owned_vertex{}, owned_edge{};  ///< the first so many are meant; edges by rank
  int owned_vertex_count = 0, owned_edge_count = 0;
};

struct PairFeatures {
  int vertex_count = 0;
  std::vector<Triangle> faces;               ///< by rank
  std::vector<Edge> edges;                   ///< by rank
  std::vector<PairElement> cloth, collider;  ///< in the order of the triangles

  // Of one search. What has an inverted box, or a vertex that has, is nowhere: (infinity, -infinity).
  std::vector<VertexBox> vertex_boxes, edge_boxes, face_boxes;
  std::vector<VertexBox> cloth_boxes, collider_boxes;  ///< of all that an element may own

  PairFeatures(int cloth_vertex_count, std::span<const Triangle> cloth_triangles, int collider_vertex_count,
               std::span<const Triangle> collider_triangles);
  void set_boxes(std::span<const VertexBox> boxes);
};

}  // namespace ft
