// Features of the two surfaces of a pair search, numbered: faces in the order of their triangles, of which there is no
// copy, edges by their lexicographic rank; and for every triangle the features it stands for (its own vertices and
// edges), so that every feature is owned exactly once. Boxes of edges and faces are joined from those of vertices where
// they are looked at, which costs less than to keep them. For pair_finder.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "collision/broad_phase/pair_list.h"
#include "collision/broad_phase/vertex_box.h"

namespace ft::inline collision {

/// A triangle as the search sees it.
struct PairElement {
  int triangle = 0;                 ///< its number, that of its face where it has one
  std::array<int, 3> owned_edge{};  ///< by rank; the first owned_edge_count are meant
  std::uint8_t owned_edge_count = 0;
  std::uint8_t owned_vertices = 0;  ///< bit k: corner k
  bool has_face = false;            ///< not a cord, nor an earlier triangle again
};

struct PairFeatures {
  int vertex_count = 0;
  std::span<const Triangle> cloth_faces;     ///< the caller's triangles, cords among them, as faces are numbered
  std::vector<Triangle> collider_faces;      ///< the numbers that follow
  std::span<const Edge> cloth_edges;         ///< by rank, first the cloth's
  std::vector<Edge> own_cloth_edges;         ///< what cloth_edges sees, unless it is the caller's
  std::vector<Edge> collider_edges;          ///< the ranks that follow
  std::vector<PairElement> cloth, collider;  ///< in the order of the triangles, until there are trees over them

  /// Of one search. What has a vertex that is nowhere is so too.
  std::span<const VertexBox> vertex_boxes;
  bool all_present = true;  ///< no vertex is nowhere

  /// As PairFinder's.
  PairFeatures(int cloth_vertex_count, std::span<const Triangle> cloth_triangles, int collider_vertex_count,
               std::span<const Triangle> collider_triangles, std::span<const Edge> known_edges);
  PairFeatures(PairFeatures&&) noexcept = default;  // no copies: cloth_edges may see its own list
  std::size_t edge_count() const { return cloth_edges.size() + collider_edges.size(); }
  FeatureNumbers numbers() const { return {cloth_faces, collider_faces, cloth_edges, collider_edges}; }
  const Edge& edge(int rank) const { return numbers().edge(rank); }
  void set_boxes(std::span<const VertexBox> boxes);
  bool present(int v) const { return all_present || !vertex_boxes[at(v)].is_nowhere(); }
  BoxLanes box(int v) const { return BoxLanes::load(vertex_boxes[at(v)]); }
  BoxLanes box(const Edge& e) const { return box(e[0]).join(box(e[1])); }
  const Triangle& corners(const PairElement& e) const { return numbers().face(e.triangle); }
  /// Joins the vertices that are somewhere: an element without its third vertex may still own an edge.
  BoxLanes box(const Triangle& t) const { return box(t[0]).join(box(t[1])).join(box(t[2])); }
  BoxLanes box(const PairElement& e) const { return box(corners(e)); }
};

}  // namespace ft::inline collision
