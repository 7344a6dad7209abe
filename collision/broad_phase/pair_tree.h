// The box tree over the triangles of one surface: arranged by FCL (fcl_pair_tree.cpp), then kept, refitted and walked
// by our own code, which takes less than half of the time of FCL's virtual traversal. For pair_finder.cpp.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "collision/broad_phase/node_patches.h"
#include "collision/broad_phase/pair_features.h"
#include "collision/broad_phase/pair_node.h"

namespace ft::inline collision {

/// Its leaves hold the elements.
class PairTree {
 public:
  bool built() const { return !nodes_.empty(); }
  const PairNode* nodes() const { return nodes_.data(); }
  const PairElement* elements() const { return elements_.data(); }
  /// Per node: whether an element below it changed in the last refit of some.
  const char* marks() const { return marks_.data(); }
  /// Per node: the patches that everything below it is in.
  const NodePatches& patches() const { return patches_; }

  /// place_of(vertex): in any unit. patches_of: per element, ascending; no rows: none.
  void build(std::span<const PairElement> elements, const PairFeatures& features,
             const std::function<Vec3f(int)>& place_of, const Adjacency& patches_of);

  /// A refit is begin_refit(), refit_below() for all limbs in any order, end_refit(). changed (per vertex) not empty:
  /// all other boxes are those of the last refit.
  void begin_refit(const PairFeatures& features, std::span<const char> changed);
  std::size_t limb_count() const { return limbs_.size(); }
  void refit_below(std::size_t limb, const PairFeatures& features, std::span<const char> changed);
  void end_refit(const PairFeatures& features, std::span<const char> changed);

 private:
  bool is_changed(const PairNode& leaf, const PairFeatures& features, std::span<const char> changed) const;
  BoxLanes box_of(const PairNode& leaf, const PairFeatures& features) const;
  void refit(std::size_t k, const PairFeatures& features, std::span<const char> changed);
  void share_out();

  std::vector<PairNode> nodes_;
  std::vector<PairElement> elements_;  ///< in the order of their leaves
  std::vector<char> marks_;
  NodePatches patches_;
  struct Limb {
    std::size_t begin, end;
  };
  std::vector<Limb> limbs_;
  std::vector<std::size_t> trunk_;  ///< all other nodes, ascending
  bool any_mark_ = false;
  bool any_mark_now_ = true;               ///< in the refit at hand, or all
  int first_vertex_ = 0, end_vertex_ = 0;  ///< all vertices of the elements are in here
};

}  // namespace ft::inline collision
