// Pairs of features by their numbers, one key each: half of the room of stencils, where folds of fine cloth have
// millions of pairs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/core/types.h"
#include "collision/contact_pairs.h"

namespace ft {

/// Of a vertex and a face, or of two edges, by their numbers; the first in the high half.
using PairKey = std::uint64_t;

constexpr PairKey pair_key(int first, int second) {
  return static_cast<PairKey>(static_cast<std::uint32_t>(first)) << 32 | static_cast<std::uint32_t>(second);
}
constexpr int key_first(PairKey key) {
  return static_cast<int>(key >> 32);
}
constexpr int key_second(PairKey key) {
  return static_cast<int>(key & 0xffffffffu);
}

/// What the numbers mean. All lists are ascending, so that ascending keys are ascending stencils; they have to stay.
struct FeatureNumbers {
  std::span<const Triangle> faces;
  std::span<const Edge> cloth_edges;
  std::span<const Edge> collider_edges;  ///< their numbers go on from there

  const Edge& edge(int number) const {
    const std::size_t k = at(number);
    return k < cloth_edges.size() ? cloth_edges[k] : collider_edges[k - cloth_edges.size()];
  }
  Stencil stencil(PairKind kind, PairKey key) const {
    if (kind == PairKind::k_vertex_face) {
      const Triangle& f = faces[at(key_second(key))];
      return {{key_first(key), f[0], f[1], f[2]}};
    }
    const Edge &a = edge(key_first(key)), &b = edge(key_second(key));
    return {{a[0], a[1], b[0], b[1]}};
  }
};

struct PairKeys {
  std::vector<PairKey> vertex_face, edge_edge;

  const std::vector<PairKey>& of(PairKind kind) const {
    return kind == PairKind::k_vertex_face ? vertex_face : edge_edge;
  }
};

struct PairList : PairKeys {
  FeatureNumbers features;

  Stencil stencil(PairKind kind, std::size_t i) const { return features.stencil(kind, of(kind)[i]); }
};

}  // namespace ft
