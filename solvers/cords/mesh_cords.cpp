#include <algorithm>

#include "baker/core/check.h"
#include "solvers/cords/generators.h"

namespace ft::inline solvers {
namespace {

constexpr double k_most_cords = 1e6;
constexpr double k_least_length = 1e-6;  // m: shorter, and its stiffness EA / length is beyond any solver

/// Edges of the faces as they are, without the diagonals that triangles need; unique, sorted.
std::vector<Edge> face_edges(const Mesh& mesh) {
  std::vector<Edge> out;
  out.reserve(mesh.face_vertices.size());
  std::size_t first = 0;
  for (const int size : mesh.face_sizes) {
    for (std::size_t k = 0; k < at(size); ++k) {
      const int a = mesh.face_vertices[first + k], b = mesh.face_vertices[first + (k + 1) % at(size)];
      out.push_back({std::min(a, b), std::max(a, b)});
    }
    first += at(size);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Status hold_group(const Mesh& mesh, std::string_view name, std::span<const int> point_of, CordGraph& graph) {
  if (name.empty()) return {};
  const auto group =
      std::find_if(mesh.groups.begin(), mesh.groups.end(), [&](const VertexGroup& g) { return g.name == name; });
  if (group == mesh.groups.end()) {
    std::string there;
    for (const VertexGroup& g : mesh.groups) there.append(there.empty() ? "there are: " : ", ").append(g.name);
    return input_error("has no vertex group \"" + std::string(name) + "\"", mesh.name,
                       there.empty() ? "it has no groups" : there);
  }
  for (std::size_t i = 0; i < group->vertices.size(); ++i)
    if (const int point = point_of[at(group->vertices[i])]; point >= 0 && group->weights[i] > 0)
      graph.held.push_back(point);
  std::sort(graph.held.begin(), graph.held.end());
  graph.held.erase(std::unique(graph.held.begin(), graph.held.end()), graph.held.end());
  return {};
}

}  // namespace

Result<CordGraph> cords_of_mesh(const Mesh& mesh, std::string_view held_group, int pieces) {
  const std::vector<Edge> edges = face_edges(mesh);
  if (edges.empty()) return input_error("has no faces, whose edges would be cords", mesh.name);
  if (static_cast<double>(edges.size()) * pieces > k_most_cords)
    return input_error("would be more than a million cords: it has " + std::to_string(edges.size()) +
                           " edges, each in " + std::to_string(pieces) + (pieces == 1 ? " piece" : " pieces"),
                       mesh.name);
  std::vector<int> point_of(mesh.positions.size(), -1);
  for (const Edge& edge : edges)
    for (const int v : edge) point_of[at(v)] = 0;
  CordGraph out;
  for (std::size_t v = 0; v < point_of.size(); ++v)
    if (point_of[v] == 0) {
      point_of[v] = static_cast<int>(out.points.size());
      out.points.push_back(mesh.positions[v]);
    }
  for (const auto& [a, b] : edges) {
    if ((mesh.positions[at(b)] - mesh.positions[at(a)]).norm() < pieces * k_least_length)
      return input_error("the edge between its vertices " + std::to_string(a) + " and " + std::to_string(b) +
                             " has no length to make a cord of",
                         mesh.name, "join vertices at one place");
    add_side(out, point_of[at(a)], point_of[at(b)], pieces);
  }
  if (const Status held = hold_group(mesh, held_group, point_of, out); !held) return held.error();
  join_strands(out);
  return out;
}

}  // namespace ft::inline solvers
