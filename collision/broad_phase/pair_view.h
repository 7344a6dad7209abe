// Pairs to look at, wherever they are: stencils, or some of the pairs of a list. Folds of fine cloth have hundreds of
// thousands of pairs near enough to be looked at, next to the list that has them already.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/broad_phase/pair_list.h"

namespace ft::inline collision {

/// Some pairs of a list, which has to stay, by their places in it.
struct PairPlaces {
  const PairList* list = nullptr;
  std::vector<std::uint32_t> vertex_face, edge_edge;
};

/// What it sees has to stay.
class PairView {
 public:
  PairView(const ContactPairs& pairs) : stencils_(&pairs) {}  // NOLINT(google-explicit-constructor)
  PairView(const PairPlaces& places) : places_(&places) {}    // NOLINT(google-explicit-constructor)

  std::size_t count(PairKind kind) const {
    const bool face = kind == PairKind::k_vertex_face;
    if (stencils_ != nullptr) return (face ? stencils_->vertex_face : stencils_->edge_edge).size();
    return (face ? places_->vertex_face : places_->edge_edge).size();
  }
  Stencil stencil(PairKind kind, std::size_t i) const {
    const bool face = kind == PairKind::k_vertex_face;
    if (stencils_ != nullptr) return (face ? stencils_->vertex_face : stencils_->edge_edge)[i];
    return places_->list->stencil(kind, (face ? places_->vertex_face : places_->edge_edge)[i]);
  }

 private:
  const ContactPairs* stencils_ = nullptr;
  const PairPlaces* places_ = nullptr;
};

}  // namespace ft::inline collision
