// See pair_features.h. All sizes are fixed at the start; a search only writes boxes.
#include "collision/broad_phase/pair_features.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft::inline collision {
namespace {

constexpr std::size_t k_block = 4096;

bool is_cord(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

template <class T>
std::size_t rank(std::span<const T> sorted, const T& value) {
  return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
}

/// Per triangle: 1 where an earlier one is the same, else 0.
std::vector<char> repeated(std::size_t count, const FeatureNumbers& triangles) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto less = [&](int a, int b) { return triangles.face(a) < triangles.face(b); };
  std::stable_sort(order.begin(), order.end(), less);
  std::vector<char> out(count, 0);
  for (std::size_t i = 1; i < count; ++i) out[at(order[i])] = !less(order[i - 1], order[i]);
  return out;
}

std::vector<Edge> edges_of(std::span<const Triangle> triangles) {
  std::vector<Edge> edges = unique_edges(triangles);
  std::erase_if(edges, [](const Edge& e) { return e[0] == e[1]; });
  return edges;
}

}  // namespace

PairFeatures::PairFeatures(int cloth_vertex_count, std::span<const Triangle> cloth_triangles, int collider_vertex_count,
                           std::span<const Triangle> collider_triangles, std::span<const Edge> known_edges)
    : vertex_count(cloth_vertex_count + collider_vertex_count),
      cloth_faces(cloth_triangles),
      collider_faces(collider_triangles.begin(), collider_triangles.end()),
      cloth_edges(known_edges),
      collider_edges(edges_of(collider_triangles)) {
  if (std::vector<Edge> found = edges_of(cloth_triangles); !std::ranges::equal(found, known_edges)) {
    own_cloth_edges = std::move(found);
    cloth_edges = own_cloth_edges;
  }

  cloth.reserve(cloth_triangles.size());
  collider.reserve(collider_triangles.size());
  const FeatureNumbers known = numbers();
  const std::size_t triangle_count = cloth_triangles.size() + collider_triangles.size();
  const std::vector<char> again = repeated(triangle_count, known);
  std::vector<char> edge_owned(edge_count()), vertex_owned(at(vertex_count));
  const auto take = [](std::vector<char>& owned, std::size_t i) {
    const bool free = !owned[i];
    owned[i] = 1;
    return free;
  };
  for (std::size_t k = 0; k < triangle_count; ++k) {
    const bool of_cloth = k < cloth_triangles.size();
    PairElement e;
    e.triangle = static_cast<int>(k);
    const Triangle& v = known.face(e.triangle);
    e.has_face = !is_cord(v) && again[k] == 0;
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(v[i] >= 0 && v[i] < vertex_count);
      CHECK(of_cloth == (v[i] < cloth_vertex_count));
      const auto [lo, hi] = std::minmax(v[i], v[(i + 1) % 3]);
      if (lo == hi) continue;
      const std::size_t edge =
          of_cloth ? rank<Edge>(cloth_edges, {lo, hi}) : cloth_edges.size() + rank<Edge>(collider_edges, {lo, hi});
      if (take(edge_owned, edge)) e.owned_edge[at(e.owned_edge_count++)] = static_cast<int>(edge);
    }
    for (std::size_t i = 0; i < 3; ++i)
      if (take(vertex_owned, at(v[i]))) e.owned_vertices |= static_cast<std::uint8_t>(1u << i);
    (of_cloth ? cloth : collider).push_back(e);
  }
}

void PairFeatures::set_boxes(std::span<const VertexBox> boxes) {
  CHECK(boxes.size() == at(vertex_count));
  vertex_boxes = boxes;
  all_present = parallel_sum(boxes.size(), k_block, 0, [&](std::size_t begin, std::size_t end) {
                  int nowhere = 0;
                  for (std::size_t i = begin; i < end; ++i) nowhere += boxes[i].is_nowhere();
                  return nowhere;
                }) == 0;
}

}  // namespace ft::inline collision
