// See pair_features.h. All sizes are fixed at the start; a search only writes boxes.
#include "collision/pair_features.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft {
namespace {

constexpr std::size_t k_block = 4096;
constexpr float k_infinity = std::numeric_limits<float>::infinity();
constexpr VertexBox k_nowhere{{k_infinity, k_infinity, k_infinity}, {-k_infinity, -k_infinity, -k_infinity}};

inline bool valid(const VertexBox& b) {
  return b.lo[0] <= b.hi[0] && b.lo[1] <= b.hi[1] && b.lo[2] <= b.hi[2];
}

inline VertexBox join(const VertexBox& a, const VertexBox& b) {
  return {{std::min(a.lo[0], b.lo[0]), std::min(a.lo[1], b.lo[1]), std::min(a.lo[2], b.lo[2])},
          {std::max(a.hi[0], b.hi[0]), std::max(a.hi[1], b.hi[1]), std::max(a.hi[2], b.hi[2])}};
}

/// A feature with a vertex that is nowhere is nowhere.
inline VertexBox join_present(const VertexBox& a, const VertexBox& b) {
  return valid(a) && valid(b) ? join(a, b) : k_nowhere;
}

template <class T>
std::size_t rank(const std::vector<T>& sorted, const T& value) {
  return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
}

}  // namespace

VertexBox VertexBox::swept(const Vec3& a, const Vec3& b, double r) {
  VertexBox out;
  for (int i = 0; i < 3; ++i) {
    // 1.2e-7 of a float is more than its last bit, which covers the rounding of the line before as well.
    const auto lo = static_cast<float>(std::min(a[i], b[i]) - r), hi = static_cast<float>(std::max(a[i], b[i]) + r);
    out.lo[at(i)] = lo - std::abs(lo) * 1.2e-7f - 1e-37f;
    out.hi[at(i)] = hi + std::abs(hi) * 1.2e-7f + 1e-37f;
  }
  return out;
}

PairFeatures::PairFeatures(int cloth_vertex_count, std::span<const Triangle> cloth_triangles, int collider_vertex_count,
                           std::span<const Triangle> collider_triangles)
    : vertex_count(cloth_vertex_count + collider_vertex_count) {
  std::vector<Triangle> all(cloth_triangles.begin(), cloth_triangles.end());
  all.insert(all.end(), collider_triangles.begin(), collider_triangles.end());
  faces = all;
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  edges = unique_edges(all);
  std::erase_if(edges, [](const Edge& e) { return e[0] == e[1]; });

  std::vector<char> face_owned(faces.size()), edge_owned(edges.size()), vertex_owned(at(vertex_count));
  const auto take = [](std::vector<char>& owned, std::size_t i) {
    const bool free = !owned[i];
    owned[i] = 1;
    return free;
  };
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool of_cloth = k < cloth_triangles.size();
    PairElement e;
    e.v = all[k];
    const std::size_t face = rank(faces, e.v);
    e.face = take(face_owned, face) ? static_cast<int>(face) : -1;
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(e.v[i] >= 0 && e.v[i] < vertex_count);
      CHECK(of_cloth == (e.v[i] < cloth_vertex_count));
      if (take(vertex_owned, at(e.v[i]))) e.owned_vertex[at(e.owned_vertex_count++)] = e.v[i];
      const auto [lo, hi] = std::minmax(e.v[i], e.v[(i + 1) % 3]);
      if (lo == hi) continue;
      const std::size_t edge = rank(edges, Edge{lo, hi});
      if (take(edge_owned, edge)) e.owned_edge[at(e.owned_edge_count++)] = static_cast<int>(edge);
    }
    (of_cloth ? cloth : collider).push_back(e);
  }
}

void PairFeatures::set_boxes(std::span<const VertexBox> boxes) {
  CHECK(boxes.size() == at(vertex_count));
  vertex_boxes.resize(boxes.size());
  edge_boxes.resize(edges.size());
  face_boxes.resize(faces.size());
  parallel_for(boxes.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) vertex_boxes[i] = valid(boxes[i]) ? boxes[i] : k_nowhere;
  });
  const auto of = [&](int v) -> const VertexBox& { return vertex_boxes[at(v)]; };
  parallel_for(edges.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) edge_boxes[i] = join_present(of(edges[i][0]), of(edges[i][1]));
  });
  parallel_for(faces.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      face_boxes[i] = join_present(join_present(of(faces[i][0]), of(faces[i][1])), of(faces[i][2]));
  });
  // An element without its third vertex may still own an edge: its box joins the vertices that are somewhere.
  const auto of_elements = [&](const std::vector<PairElement>& elements, std::vector<VertexBox>& out) {
    out.resize(elements.size());
    parallel_for(out.size(), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Triangle& v = elements[i].v;
        out[i] = join(join(of(v[0]), of(v[1])), of(v[2]));
      }
    });
  };
  of_elements(cloth, cloth_boxes);
  of_elements(collider, collider_boxes);
}

}  // namespace ft
