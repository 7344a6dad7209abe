// Search for candidate pairs: features of two surfaces, or of one, whose boxes overlap, over one numbering of all
// vertices (contact_pairs.h). Found with box trees.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "baker/core/ascending_rows.h"
#include "baker/core/types.h"
#include "collision/broad_phase/pair_list.h"
#include "collision/broad_phase/vertex_box.h"

namespace ft::inline collision {

/// Whether a pair is wanted. A search asks once for every pair that it comes upon, from several threads and in any
/// order, so that lists never hold what nobody wants. May be empty: all are.
using PairSieve = std::function<bool(PairKind, const Stencil&)>;

class PairFinder {
 public:
  /// Triangles index the common numbering; collider_triangles' indices are all >= cloth_vertex_count. A triangle with
  /// a vertex twice, {a, b, b}, is a cord: an edge and its ends, and no face. The cloth's triangles have to stay.
  /// known_edges: the cloth's, sorted, which then have to stay; where they are not that, or none, it keeps its own.
  PairFinder(int cloth_vertex_count, std::span<const Triangle> cloth_triangles, int collider_vertex_count,
             std::span<const Triangle> collider_triangles, std::span<const Edge> known_edges = {});
  ~PairFinder();
  PairFinder(PairFinder&&) noexcept;

  /// Arranges the trees for places like these (per vertex [m]), once: calls after the first do nothing. Without it they
  /// are arranged for the boxes of the first search, which hardly differ where they are endless. No result hangs on it.
  void arrange(std::span<const Vec3> x);

  /// Of all searches from now on: cloth and cloth are a pair only where their boxes overlap by as much, what the boxes
  /// have for the collider's sake; nothing at first.
  void set_self_margin(const BoxMargin& self_margin);

  /// Patches: sets of cloth triangles, a row each, for `skipped`. Before the first search.
  void set_patches(const AscendingRows& members);

  /// boxes: of one frame; they must stay where they are until the search is over. Lists are in ascending order, each
  /// pair once, and see the finder's features: it has to stay.
  /// All vertex-face and edge-edge pairs whose feature boxes (union of vertex boxes) overlap: cloth against collider,
  /// and with self also cloth against cloth. Complete: a pair that can meet while every vertex stays in its box is in
  /// the list. Pairs that share a vertex are left out. Vertices that are VertexBox::nowhere() take part in nothing.
  /// skipped (per patch; empty: none): where it is not 0, pairs of features of two triangles in the patch are left out.
  void find(std::span<const VertexBox> boxes, bool self, PairList& out, std::span<const char> skipped = {},
            const PairSieve& sieve = {});
  /// The vertex-face pairs of find() alone; leaves no edge-edge pairs.
  void find_vertex_face(std::span<const VertexBox> boxes, bool self, PairList& out, const PairSieve& sieve = {});
  /// The pairs of find() that have a vertex whose `changed` (per vertex) is not 0: what a list of before lacks when
  /// only their boxes have grown or moved. All other boxes must be those of the last search. Costs little where few
  /// have changed.
  void find_changed(std::span<const VertexBox> boxes, bool self, std::span<const char> changed, PairList& out,
                    std::span<const char> skipped = {}, const PairSieve& sieve = {});

 private:
  void build_trees(const std::function<Vec3f(int)>& place_of);
  void search(std::span<const VertexBox> boxes, bool self, bool edges, std::span<const char> changed,
              std::span<const char> skipped, const PairSieve& sieve, PairList& out);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ft::inline collision
