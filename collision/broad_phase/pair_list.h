// Pairs of features by their numbers, one key each: half of the room of stencils, where folds of fine cloth have
// millions of pairs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/core/types.h"
#include "collision/broad_phase/contact_pairs.h"

namespace ft::inline collision {

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

/// What the numbers mean; those of the collider go on from those of the cloth. All lists have to stay.
struct FeatureNumbers {
  std::span<const Triangle> cloth_faces, collider_faces;
  std::span<const Edge> cloth_edges, collider_edges;

  const Triangle& face(int number) const { return of(cloth_faces, collider_faces, at(number)); }
  const Edge& edge(int number) const { return of(cloth_edges, collider_edges, at(number)); }
  Stencil stencil(PairKind kind, PairKey key) const {
    if (kind == PairKind::k_vertex_face) {
      const Triangle& f = face(key_second(key));
      return {{key_first(key), f[0], f[1], f[2]}};
    }
    const Edge &a = edge(key_first(key)), &b = edge(key_second(key));
    return {{a[0], a[1], b[0], b[1]}};
  }

 private:
  template <class Feature>
  static const Feature& of(std::span<const Feature> cloth, std::span<const Feature> collider, std::size_t k) {
    return k < cloth.size() ? cloth[k] : collider[k - cloth.size()];
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

}  // namespace ft::inline collision
