// Pairs as the pair finder lists them, from stencils and to stencils.
#pragma once

#include <algorithm>
#include <vector>

#include "collision/broad_phase/pair_finder.h"

namespace ft::test {

/// The same pairs in the same order, each by its vertices.
inline ContactPairs stencils_of(const PairList& list) {
  ContactPairs out;
  for (const PairKey key : list.vertex_face)
    out.vertex_face.push_back(list.features.stencil(PairKind::k_vertex_face, key));
  for (const PairKey key : list.edge_edge) out.edge_edge.push_back(list.features.stencil(PairKind::k_edge_edge, key));
  return out;
}

/// Features have the numbers that they have among those of all pairs. The list sees them: no copies.
struct NumberedPairs {
  std::vector<Triangle> faces;
  std::vector<Edge> edges;
  PairList list;  ///< in the order of the stencils

  explicit NumberedPairs(const ContactPairs& pairs) {
    const auto face_of = [](const Stencil& s) { return Triangle{s.v[1], s.v[2], s.v[3]}; };
    const auto first_edge = [](const Stencil& s) { return Edge{s.v[0], s.v[1]}; };
    const auto second_edge = [](const Stencil& s) { return Edge{s.v[2], s.v[3]}; };
    for (const Stencil& s : pairs.vertex_face) faces.push_back(face_of(s));
    for (const Stencil& s : pairs.edge_edge) edges.push_back(first_edge(s)), edges.push_back(second_edge(s));
    const auto order = [](auto& features) {
      std::sort(features.begin(), features.end());
      features.erase(std::unique(features.begin(), features.end()), features.end());
    };
    order(faces);
    order(edges);
    const auto number = [](const auto& features, const auto& feature) {
      return static_cast<int>(std::lower_bound(features.begin(), features.end(), feature) - features.begin());
    };
    for (const Stencil& s : pairs.vertex_face) list.vertex_face.push_back(pair_key(s.v[0], number(faces, face_of(s))));
    for (const Stencil& s : pairs.edge_edge)
      list.edge_edge.push_back(pair_key(number(edges, first_edge(s)), number(edges, second_edge(s))));
    list.features = {faces, {}, edges, {}};
  }
  NumberedPairs(const NumberedPairs&) = delete;
  NumberedPairs& operator=(const NumberedPairs&) = delete;
};

inline ContactPairs sorted_stencils_of(const PairList& list) {
  ContactPairs out = stencils_of(list);
  std::sort(out.vertex_face.begin(), out.vertex_face.end());
  std::sort(out.edge_edge.begin(), out.edge_edge.end());
  return out;
}

/// A finder that gives stencils, sorted.
struct StencilFinder : PairFinder {
  using PairFinder::PairFinder;

  void find(std::span<const VertexBox> boxes, bool self, ContactPairs& out, std::span<const char> skipped = {}) {
    PairList list;
    PairFinder::find(boxes, self, list, skipped);
    out = sorted_stencils_of(list);
  }
  void find_vertex_face(std::span<const VertexBox> boxes, bool self, ContactPairs& out) {
    PairList list;
    PairFinder::find_vertex_face(boxes, self, list);
    out = sorted_stencils_of(list);
  }
  void find_changed(std::span<const VertexBox> boxes, bool self, std::span<const char> changed, ContactPairs& out,
                    std::span<const char> skipped = {}) {
    PairList list;
    PairFinder::find_changed(boxes, self, changed, list, skipped);
    out = sorted_stencils_of(list);
  }
};

}  // namespace ft::test
