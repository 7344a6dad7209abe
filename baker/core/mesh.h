// Mesh: what a file holds, in the file's own vertex order, because caches are written back in that order.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/types.h"

namespace ft {

/// Named vertices with weights in [0, 1]: a painted pin group, a vertex map.
struct VertexGroup {
  std::string name;
  std::vector<int> vertices;
  std::vector<double> weights;  ///< same length as vertices
};

/// A vertex sewn to a point of an edge: at (1 - place) x[edge[0]] + place x[edge[1]]. Both ends may be one vertex.
struct Stitch {
  int vertex = 0;
  std::array<int, 2> edge{};
  double place = 0;  ///< 0..1
  int seam = 0;      ///< stitches of one seam share a number, from 0 without gaps
  auto operator<=>(const Stitch&) const = default;
};

struct Mesh {
  std::string name;
  std::vector<Vec3> positions;     ///< m
  std::vector<int> face_sizes;     ///< corners per face, >= 3
  std::vector<int> face_vertices;  ///< corners of all faces in turn, counter-clockwise seen from outside
  std::vector<Vec2> uvs;           ///< pattern coordinates; empty when the file has none
  std::vector<int> face_uvs;       ///< as face_vertices, into uvs; empty when uvs is
  std::vector<VertexGroup> groups;
  std::vector<Stitch> stitches;  ///< what closes panels into a garment; in the file's order

  int vertex_count() const { return static_cast<int>(positions.size()); }
  int face_count() const { return static_cast<int>(face_sizes.size()); }
};

/// Mesh of triangles.
Mesh make_triangle_mesh(std::string name, std::vector<Vec3> positions, std::span<const Triangle> triangles);

/// Splits faces by the shorter diagonal (quads) or as a fan from the first corner (more corners); triangles in face
/// order.
std::vector<Triangle> triangulate(const Mesh& mesh);

/// The same where there is nothing to split, without a copy; else none. The mesh has to stay.
std::span<const Triangle> as_triangles(const Mesh& mesh);

/// Unique edges, sorted.
std::vector<Edge> unique_edges(std::span<const Triangle> triangles);

/// Vertex -> neighbouring vertices or elements in compressed rows, each row ascending.
struct Adjacency {
  std::vector<int> start;  ///< size rows + 1
  std::vector<int> items;
  std::span<const int> row(int i) const {
    return {items.data() + start[static_cast<std::size_t>(i)], items.data() + start[static_cast<std::size_t>(i) + 1]};
  }
  int row_count() const { return static_cast<int>(start.size()) - 1; }
};

/// Row i lists the vertices that an edge joins to vertex i.
Adjacency vertex_neighbours(std::size_t vertex_count, std::span<const Edge> edges);
/// Row i lists the triangles around vertex i.
Adjacency vertex_triangles(int vertex_count, std::span<const Triangle> triangles);

/// Area-weighted vertex normals, unit length (zero where a vertex has no area).
std::vector<Vec3> vertex_normals(std::span<const Vec3> positions, std::span<const Triangle> triangles);

/// Columns: its first edge, what is square to both, its normal; the identity where it has no area.
Mat3 triangle_frame(const Vec3& a, const Vec3& b, const Vec3& c);

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c);

/// Pieces of a surface that are not joined by triangles: one index per vertex, numbered by first vertex; vertices
/// without triangles join piece 0.
std::vector<int> connected_pieces(int vertex_count, std::span<const Triangle> triangles, int& piece_count);

}  // namespace ft
