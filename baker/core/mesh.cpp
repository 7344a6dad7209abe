#include "baker/core/mesh.h"

#include <algorithm>
#include <numeric>

#include "baker/core/disjoint_sets.h"
#include "baker/core/triangle_corners.h"

namespace ft {

Mesh make_triangle_mesh(std::string name, std::vector<Vec3> positions, std::span<const Triangle> triangles) {
  Mesh mesh;
  mesh.name = std::move(name);
  mesh.positions = std::move(positions);
  mesh.face_sizes.assign(triangles.size(), 3);
  for (const Triangle& t : triangles) mesh.face_vertices.insert(mesh.face_vertices.end(), t.begin(), t.end());
  return mesh;
}

std::vector<Triangle> triangulate(const Mesh& mesh) {
  std::vector<Triangle> out = triangle_corners(mesh);
  for (Triangle& t : out)
    for (int& v : t) v = mesh.face_vertices[at(v)];
  return out;
}

std::span<const Triangle> as_triangles(const Mesh& mesh) {
  if (mesh.face_vertices.size() != 3 * mesh.face_sizes.size() ||
      std::any_of(mesh.face_sizes.begin(), mesh.face_sizes.end(), [](int size) { return size != 3; }))
    return {};
  static_assert(sizeof(Triangle) == 3 * sizeof(int) && alignof(Triangle) == alignof(int));
  return {reinterpret_cast<const Triangle*>(mesh.face_vertices.data()), mesh.face_sizes.size()};
}

std::vector<Edge> unique_edges(std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(triangles.size() * 3);
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  edges.shrink_to_fit();
  return edges;
}

Adjacency vertex_neighbours(std::size_t vertex_count, std::span<const Edge> edges) {
  Adjacency out;
  out.start.assign(vertex_count + 1, 0);
  for (const Edge& e : edges)
    for (const int v : e) ++out.start[at(v) + 1];
  std::partial_sum(out.start.begin(), out.start.end(), out.start.begin());
  out.items.resize(2 * edges.size());
  std::vector<int> next(out.start.begin(), out.start.end() - 1);
  // Of sorted edges, the lower neighbours of all vertices first: rows are ascending then.
  for (const Edge& e : edges) out.items[at(next[at(e[1])]++)] = e[0];
  for (const Edge& e : edges) out.items[at(next[at(e[0])]++)] = e[1];
  for (std::size_t i = 0; i < vertex_count; ++i) {
    const auto begin = out.items.begin() + out.start[i], end = out.items.begin() + out.start[i + 1];
    if (!std::is_sorted(begin, end)) std::sort(begin, end);
  }
  return out;
}

Adjacency vertex_triangles(int vertex_count, std::span<const Triangle> triangles) {
  Adjacency out;
  out.start.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (const Triangle& t : triangles)
    for (const int v : t) ++out.start[static_cast<std::size_t>(v) + 1];
  for (std::size_t i = 1; i < out.start.size(); ++i) out.start[i] += out.start[i - 1];
  out.items.resize(triangles.size() * 3);
  std::vector<int> next(out.start.begin(), out.start.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const int v : triangles[t])
      out.items[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = static_cast<int>(t);
  return out;
}

std::vector<Vec3> vertex_normals(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  std::vector<Vec3> normals(positions.size(), Vec3::Zero());
  const auto at = [&](int i) -> const Vec3& { return positions[static_cast<std::size_t>(i)]; };
  for (const Triangle& t : triangles) {
    const Vec3 n = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
    for (const int v : t) normals[static_cast<std::size_t>(v)] += n;
  }
  for (Vec3& n : normals) {
    const double length = n.norm();
    n = length > 0 ? (n / length).eval() : Vec3::Zero().eval();
  }
  return normals;
}

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

std::vector<int> connected_pieces(int vertex_count, std::span<const Triangle> triangles, int& piece_count) {
  DisjointSets pieces(at(vertex_count));
  std::vector<char> used(at(vertex_count), 0);
  for (const Triangle& t : triangles)
    for (const int v : t) {
      used[at(v)] = 1;
      pieces.join(t[0], v);
    }
  std::vector<int> number(used.size(), -1), out(used.size(), 0);
  piece_count = 0;
  for (int v = 0; v < vertex_count; ++v) {
    if (used[at(v)] == 0) continue;
    int& n = number[at(pieces.root(v))];
    if (n < 0) n = piece_count++;
    out[at(v)] = n;
  }
  piece_count = std::max(piece_count, 1);
  return out;
}

Mat3 triangle_frame(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 e = b - a, n = e.cross(c - a);
  if (e.norm() < 1e-12 || n.norm() < 1e-18) return Mat3::Identity();
  Mat3 frame;
  frame.col(0) = e.normalized();
  frame.col(2) = n.normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

}  // namespace ft
