// See pair_features.h. All sizes are fixed at the start; a search only writes boxes.
#include "collision/pair_features.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft {
namespace {

constexpr std::size_t k_block = 4096;

bool is_cord(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

template <class T>
std::size_t rank(std::span<const T> sorted, const T& value) {
  return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
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
      cloth_edges(known_edges),
      collider_edges(edges_of(collider_triangles)) {
  std::vector<Triangle> all(cloth_triangles.begin(), cloth_triangles.end());
  all.insert(all.end(), collider_triangles.begin(), collider_triangles.end());
  faces = all;
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  std::erase_if(faces, is_cord);
  faces.shrink_to_fit();
  if (std::vector<Edge> found = edges_of(cloth_triangles); !std::ranges::equal(found, known_edges)) {
    own_cloth_edges = std::move(found);
    cloth_edges = own_cloth_edges;
  }

  cloth.reserve(cloth_triangles.size());
  collider.reserve(collider_triangles.size());
  std::vector<char> face_owned(faces.size()), edge_owned(edge_count()), vertex_owned(at(vertex_count));
  const auto take = [](std::vector<char>& owned, std::size_t i) {
    const bool free = !owned[i];
    owned[i] = 1;
    return free;
  };
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool of_cloth = k < cloth_triangles.size();
    PairElement e;
    e.v = all[k];
    e.face = -1;
    if (!is_cord(e.v)) {
      const std::size_t face = rank<Triangle>(faces, e.v);
      if (take(face_owned, face)) e.face = static_cast<int>(face);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(e.v[i] >= 0 && e.v[i] < vertex_count);
      CHECK(of_cloth == (e.v[i] < cloth_vertex_count));
      const auto [lo, hi] = std::minmax(e.v[i], e.v[(i + 1) % 3]);
      if (lo == hi) continue;
      const std::size_t edge =
          of_cloth ? rank<Edge>(cloth_edges, {lo, hi}) : cloth_edges.size() + rank<Edge>(collider_edges, {lo, hi});
      if (take(edge_owned, edge)) e.owned_edge[at(e.owned_edge_count++)] = static_cast<int>(edge);
    }
    for (std::size_t i = 0; i < 3; ++i)
      if (take(vertex_owned, at(e.v[i]))) std::swap(e.v[i], e.v[at(e.owned_vertex_count++)]);
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

}  // namespace ft
