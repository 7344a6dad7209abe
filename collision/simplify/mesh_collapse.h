// A triangle mesh whose edges are collapsed: one of their vertices is drawn into the other, and the triangles between
// them go. Keeps the topology, the pattern's coordinates and what was drawn where. Which collapses are good, and in
// which order, is known to those who derive (mesh_coarsen.cpp, short_edges.cpp).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft::inline collision {

struct CoarsenedMesh {
  /// A point of the coarser surface: corners in its numbering, weights that sum to 1.
  struct Place {
    std::array<int, 3> vertex{};
    std::array<double, 3> weight{1, 0, 0};

    Vec3 of(std::span<const Vec3> coarser) const {
      return weight[0] * coarser[at(vertex[0])] + weight[1] * coarser[at(vertex[1])] +
             weight[2] * coarser[at(vertex[2])];
    }
  };
  std::vector<int> kept;                 ///< finer vertex of each coarser one, ascending
  std::vector<Triangle> triangles;       ///< coarser numbering
  std::vector<std::array<Vec2, 3>> uvs;  ///< as the input's
  std::vector<Place> places;             ///< of each finer vertex: the nearest point at rest
  std::vector<int> into;                 ///< of each finer vertex: the coarser one that it was drawn into, or is
};

/// 4 sqrt(3) area / sum of squared edges: 1 is equilateral, 0 has no area [1].
double shape_of(const Vec3& a, const Vec3& b, const Vec3& c);

class CollapsingMesh {
 public:
  /// `rest` has to stay alive; uvs are of the corners of each triangle, or empty.
  CollapsingMesh(std::span<const Vec3> rest, std::span<const Triangle> triangles,
                 std::span<const std::array<Vec2, 3>> uvs);
  CoarsenedMesh result() const;

 protected:
  std::vector<int> neighbours(int v) const;
  /// Triangles at an edge.
  std::vector<int> shared(int a, int b) const;
  bool on_outline(int v) const;
  /// Whether more than two triangles meet at one of its edges, or sheets touch in it.
  bool branches(int v) const;
  std::size_t corner(int triangle, int v) const;
  /// Whether the surface stays what it is when b is drawn into a; `gone` are the triangles between them.
  bool keeps_topology(int b, int a, std::span<const int> gone) const;
  /// Of a corner at b after that: what its side of the seams has at a; none where the sides do not tell or disagree.
  std::optional<Vec2> uv_after(const Vec2& uv, int b, int a, std::span<const int> gone) const;
  void draw(int b, int a);

  std::span<const Vec3> rest_;       ///< m
  std::vector<Triangle> triangles_;  ///< finer numbering; those that are gone have vertex -1
  std::vector<std::array<Vec2, 3>> uvs_;
  std::vector<std::vector<int>> around_;  ///< triangles of each vertex
  std::vector<int> into_;                 ///< what a vertex was drawn into, itself if it is left
};

}  // namespace ft::inline collision
