#include <fcl/geometry/bvh/BVH_model.h>

#include <algorithm>

#include "baker/core/check.h"
#include "collision/broad_phase/pair_tree.h"

namespace ft::inline collision {
namespace {

using FclBox = fcl::AABB<float>;

constexpr std::size_t k_limb = 256;  ///< most nodes of a limb, which is refitted as one

bool is_changed(const Triangle& t, std::span<const char> changed) {
  return (changed[at(t[0])] | changed[at(t[1])] | changed[at(t[2])]) != 0;
}

/// The nodes of FCL's tree, but for those below a node whose elements make a leaf. Returns the elements of all leaves,
/// one leaf after the other.
std::vector<int> take_nodes(const fcl::BVHModel<FclBox>& model, std::vector<PairNode>& nodes) {
  const std::size_t count = at(model.getNumBVs());
  const auto child = [&](std::size_t k) { return model.getBV(static_cast<int>(k)).first_child; };
  std::vector<int> elements_below(count);
  for (std::size_t k = count; k-- > 0;)
    elements_below[k] = child(k) < 0 ? 1 : elements_below[at(child(k))] + elements_below[at(child(k)) + 1];
  std::vector<char> in_leaf(count, 0);
  std::vector<int> number(count, 0);  // of those that are taken
  int taken = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (in_leaf[k] == 0) number[k] = taken++;
    if (child(k) >= 0 && elements_below[k] <= PairNode::k_most_elements)
      in_leaf[at(child(k))] = in_leaf[at(child(k)) + 1] = 1;
  }
  nodes.clear();
  nodes.reserve(at(taken));
  std::vector<int> order;
  order.reserve(at(elements_below[0]));
  const auto add_below = [&](auto&& self, std::size_t k) -> void {
    if (child(k) < 0) return order.push_back(-1 - child(k));
    self(self, at(child(k)));
    self(self, at(child(k)) + 1);
  };
  for (std::size_t k = 0; k < count; ++k) {
    if (in_leaf[k] != 0) continue;
    if (elements_below[k] > PairNode::k_most_elements) {
      nodes.push_back(PairNode::inner(number[at(child(k))]));
    } else {
      nodes.push_back(PairNode::leaf(static_cast<int>(order.size()), elements_below[k]));
      add_below(add_below, k);
    }
  }
  return order;
}

}  // namespace

void PairTree::build(std::span<const PairElement> elements, const PairFeatures& features,
                     const std::function<Vec3f(int)>& place_of, const Adjacency& patches_of) {
  CHECK(elements.size() < (1u << 28));  // PairNode
  std::vector<fcl::Vector3<float>> points;
  std::vector<fcl::Triangle> faces;
  points.reserve(3 * elements.size());
  first_vertex_ = end_vertex_ = elements.empty() ? 0 : features.corners(elements[0])[0];
  for (const PairElement& e : elements) {
    const std::size_t first = points.size();
    for (const int v : features.corners(e)) {
      first_vertex_ = std::min(first_vertex_, v);
      end_vertex_ = std::max(end_vertex_, v + 1);
      const fcl::Vector3<float> p = place_of(v);
      points.push_back(p.allFinite() ? p : fcl::Vector3<float>::Zero());
    }
    faces.emplace_back(first, first + 1, first + 2);
  }
  fcl::BVHModel<FclBox> model;
  CHECK(model.beginModel(static_cast<int>(faces.size()), static_cast<int>(points.size())) == fcl::BVH_OK);
  CHECK(model.addSubModel(points, faces) == fcl::BVH_OK);
  CHECK(model.endModel() == fcl::BVH_OK);
  const std::vector<int> order = take_nodes(model, nodes_);
  elements_.clear();
  elements_.reserve(elements.size());
  for (const int e : order) elements_.push_back(elements[at(e)]);
  share_out();
  if (!patches_of.items.empty())
    patches_.build(nodes_, elements.size(), [&](std::size_t e) { return patches_of.row(order[e]); });
}

void PairTree::begin_refit(const PairFeatures& features, std::span<const char> changed) {
  any_mark_now_ = true;
  if (changed.empty()) return;
  const bool was_marked = any_mark_ || marks_.size() != nodes_.size();
  any_mark_ = any_mark_now_ =
      std::any_of(changed.begin() + first_vertex_, changed.begin() + end_vertex_, [](char c) { return c; }) &&
      std::any_of(elements_.begin(), elements_.end(),
                  [&](const PairElement& e) { return ft::is_changed(features.corners(e), changed); });
  if (was_marked) marks_.assign(nodes_.size(), 0);
}

void PairTree::refit_below(std::size_t limb, const PairFeatures& features, std::span<const char> changed) {
  if (!any_mark_now_) return;
  for (std::size_t k = limbs_[limb].end; k-- > limbs_[limb].begin;) refit(k, features, changed);
}

void PairTree::end_refit(const PairFeatures& features, std::span<const char> changed) {
  if (!any_mark_now_) return;
  for (std::size_t i = trunk_.size(); i-- > 0;) refit(trunk_[i], features, changed);
}

bool PairTree::is_changed(const PairNode& leaf, const PairFeatures& features, std::span<const char> changed) const {
  bool any = false;
  for (int e = leaf.first_element(); e < leaf.end_element(); ++e)
    any |= ft::is_changed(features.corners(elements_[at(e)]), changed);
  return any;
}

BoxLanes PairTree::box_of(const PairNode& leaf, const PairFeatures& features) const {
  BoxLanes box = features.box(elements_[at(leaf.first_element())]);
  for (int e = leaf.first_element() + 1; e < leaf.end_element(); ++e) box = box.join(features.box(elements_[at(e)]));
  return box;
}

/// Node k, after its children.
void PairTree::refit(std::size_t k, const PairFeatures& features, std::span<const char> changed) {
  PairNode& node = nodes_[k];
  const bool leaf = node.is_leaf();
  const std::size_t child = leaf ? 0 : at(node.first_child());
  if (!changed.empty()) {
    marks_[k] = leaf ? static_cast<char>(is_changed(node, features, changed))
                     : static_cast<char>(marks_[child] | marks_[child + 1]);
    if (marks_[k] == 0) return;
  }
  node.set_box(leaf ? box_of(node, features) : nodes_[child].box().join(nodes_[child + 1].box()));
}

/// Limbs are all that is below a node, if that is not too much; the rest is the trunk. FCL puts what is below a node in
/// one place, behind it.
void PairTree::share_out() {
  std::vector<std::size_t> below(nodes_.size(), 0), end(nodes_.size(), 0);
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    if (nodes_[k].is_leaf()) continue;
    const std::size_t child = at(nodes_[k].first_child());
    below[k] = 2 + below[child] + below[child + 1];
    end[k] = std::max({child + 2, end[child], end[child + 1]});
  }
  std::vector<char> in_limb(nodes_.size(), 0);
  trunk_.clear();
  limbs_.clear();
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    if (in_limb[k] != 0) continue;
    trunk_.push_back(k);
    if (nodes_[k].is_leaf() || below[k] > k_limb) continue;
    const std::size_t begin = at(nodes_[k].first_child());
    CHECK(end[k] - begin == below[k]);
    limbs_.push_back({begin, end[k]});
    std::fill_n(&in_limb[begin], below[k], 1);
  }
}

}  // namespace ft::inline collision
