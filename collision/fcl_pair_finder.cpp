// Candidate pairs through FCL's trees (box trees over triangles, built once, refit in place), walked by our own
// recursion: FCL's virtual traversal takes 2.4 times as long. A pair of triangles whose boxes overlap is reduced to
// features at once: every vertex and every edge is owned by one triangle, so each pair of features comes up once.
//
// Caution: the trees are built from the first places or boxes seen, since only then is there a place for every vertex.
// They decide how long a search takes and nothing else: the result is complete for any tree and sorted, so it depends
// on boxes alone.
#include <fcl/geometry/bvh/BVH_model.h>

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "collision/contact_pairs.h"
#include "collision/pair_walk.h"

namespace ft {
namespace {

using FclBox = fcl::AABB<float>;

constexpr std::size_t k_task_goal = 256;  // sub-tree pairs that the search is split into
constexpr std::size_t k_block = 4096;
constexpr std::size_t k_limb = 256;  ///< most nodes of a limb, which is refitted as one

/// The tree of one surface; its leaves hold the elements.
class Tree {
 public:
  bool built() const { return !nodes_.empty(); }
  const PairNode* nodes() const { return nodes_.data(); }
  const PairElement* elements() const { return elements_.data(); }
  /// Per node: whether an element below it changed in the last refit() of some.
  const char* marks() const { return marks_.data(); }
  /// Per node: the patches that everything below it is in.
  const NodePatches& patches() const { return patches_; }

  /// place_of(vertex): in any unit. patches_of: per element, ascending; no rows: none.
  template <class Place>
  void build(std::span<const PairElement> elements, Place&& place_of, const Adjacency& patches_of) {
    CHECK(elements.size() < (1u << 28));  // PairNode
    std::vector<fcl::Vector3<float>> points;
    std::vector<fcl::Triangle> faces;
    points.reserve(3 * elements.size());
    first_vertex_ = end_vertex_ = elements.empty() ? 0 : elements[0].v[0];
    for (const PairElement& e : elements) {
      const std::size_t first = points.size();
      for (const int v : e.v) {
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
    const std::vector<int> order = take_nodes(model);
    elements_.clear();
    elements_.reserve(elements.size());
    for (const int e : order) elements_.push_back(elements[at(e)]);
    share_out();
    if (!patches_of.items.empty())
      patches_.build(nodes_, elements.size(), [&](std::size_t e) { return patches_of.row(order[e]); });
  }

  /// A refit is begin_refit(), refit_below() for all limbs in any order, end_refit(). changed (per vertex) not empty:
  /// all other boxes are those of the last refit.
  void begin_refit(std::span<const char> changed) {
    any_mark_now_ = true;
    if (changed.empty()) return;
    const bool was_marked = any_mark_ || marks_.size() != nodes_.size();
    any_mark_ = any_mark_now_ =
        std::any_of(changed.begin() + first_vertex_, changed.begin() + end_vertex_, [](char c) { return c; }) &&
        std::any_of(elements_.begin(), elements_.end(), [&](const PairElement& e) { return is_changed(e, changed); });
    if (was_marked) marks_.assign(nodes_.size(), 0);
  }
  std::size_t limb_count() const { return limbs_.size(); }
  void refit_below(std::size_t limb, const PairFeatures& features, std::span<const char> changed) {
    if (!any_mark_now_) return;
    for (std::size_t k = limbs_[limb].end; k-- > limbs_[limb].begin;) refit(k, features, changed);
  }
  void end_refit(const PairFeatures& features, std::span<const char> changed) {
    if (!any_mark_now_) return;
    for (std::size_t i = trunk_.size(); i-- > 0;) refit(trunk_[i], features, changed);
  }

 private:
  static bool is_changed(const PairElement& e, std::span<const char> changed) {
    return (changed[at(e.v[0])] | changed[at(e.v[1])] | changed[at(e.v[2])]) != 0;
  }

  /// The nodes of FCL's tree, but for those below a node whose elements make a leaf. Returns the elements of all
  /// leaves, one leaf after the other.
  std::vector<int> take_nodes(const fcl::BVHModel<FclBox>& model) {
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
    nodes_.clear();
    nodes_.reserve(at(taken));
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
        nodes_.push_back(PairNode::inner(number[at(child(k))]));
      } else {
        nodes_.push_back(PairNode::leaf(static_cast<int>(order.size()), elements_below[k]));
        add_below(add_below, k);
      }
    }
    return order;
  }

  bool is_changed(const PairNode& leaf, std::span<const char> changed) const {
    bool any = false;
    for (int e = leaf.first_element(); e < leaf.end_element(); ++e) any |= is_changed(elements_[at(e)], changed);
    return any;
  }
  BoxLanes box_of(const PairNode& leaf, const PairFeatures& features) const {
    BoxLanes box = features.box(elements_[at(leaf.first_element())]);
    for (int e = leaf.first_element() + 1; e < leaf.end_element(); ++e) box = box.join(features.box(elements_[at(e)]));
    return box;
  }

  /// Node k, after its children.
  void refit(std::size_t k, const PairFeatures& features, std::span<const char> changed) {
    PairNode& node = nodes_[k];
    const bool leaf = node.is_leaf();
    const std::size_t child = leaf ? 0 : at(node.first_child());
    if (!changed.empty()) {
      marks_[k] =
          leaf ? static_cast<char>(is_changed(node, changed)) : static_cast<char>(marks_[child] | marks_[child + 1]);
      if (marks_[k] == 0) return;
    }
    node.set_box(leaf ? box_of(node, features) : nodes_[child].box().join(nodes_[child + 1].box()));
  }

  /// Limbs are all that is below a node, if that is not too much; the rest is the trunk. FCL puts what is below a node
  /// in one place, behind it.
  void share_out() {
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

/// A piece of the search: two nodes that overlap, or a node of the cloth (a) against itself (b -1).
struct Task {
  int a, b;
  bool self;  ///< b is of the cloth
};

}  // namespace

struct PairFinder::Impl {
  explicit Impl(PairFeatures f) : features(std::move(f)) {}

  PairFeatures features;
  Adjacency patches_of;  ///< per cloth triangle, until there is a tree over them
  bool want_edges = true;
  std::span<const char> skipped;  ///< of the search at hand
  BoxMargin self_margin{};
  Tree cloth, collider;

  // Scratch, kept from search to search.
  std::vector<Task> tasks, next_tasks;
  PairSorter sort_vertex_face, sort_edge_edge;

  void refit(std::span<const char> changed);
  void split_tasks(bool self);
  template <bool k_some>
  void run_task(const Task& task, const char* changed, FoundPairs& out) const;
  Stencil vertex_face(std::uint64_t key) const {
    const Triangle& f = features.faces[at(key_second(key))];
    return {{key_first(key), f[0], f[1], f[2]}};
  }
  Stencil edge_edge(std::uint64_t key) const {
    const Edge &a = features.edges[at(key_first(key))], &b = features.edges[at(key_second(key))];
    return {{a[0], a[1], b[0], b[1]}};
  }
  void sift(const PairSieve& sieve, FoundPairs& pairs) const;
};

void PairFinder::Impl::refit(std::span<const char> changed) {
  parallel_tasks(2, [&](std::size_t task) { (task == 0 ? cloth : collider).begin_refit(changed); });
  const std::size_t of_cloth = cloth.limb_count();
  parallel_tasks(of_cloth + collider.limb_count(), [&](std::size_t limb) {
    limb < of_cloth ? cloth.refit_below(limb, features, changed)
                    : collider.refit_below(limb - of_cloth, features, changed);
  });
  cloth.end_refit(features, changed);
  collider.end_refit(features, changed);
}

/// Tasks depend on trees and boxes only, never on threads. Every round replaces a task by those of its children.
void PairFinder::Impl::split_tasks(bool self) {
  tasks.clear();
  if (!cloth.built()) return;
  const PairNode* ta = cloth.nodes();
  const auto overlap = [](const PairNode& a, const PairNode& b) { return a.box().overlaps(b.box()); };
  if (collider.built() && overlap(ta[0], collider.nodes()[0])) tasks.push_back({0, 0, false});
  if (self) tasks.push_back({0, -1, true});
  for (bool more = true; more && tasks.size() < k_task_goal;) {
    more = false;
    next_tasks.clear();
    for (const Task& task : tasks) {
      const int i = ta[task.a].first_child();
      if (task.b < 0) {
        if (i < 0) {
          next_tasks.push_back(task);
          continue;
        }
        next_tasks.push_back({i, -1, true});
        next_tasks.push_back({i + 1, -1, true});
        if (overlap(ta[i], ta[i + 1])) next_tasks.push_back({i, i + 1, true});
        more = true;
        continue;
      }
      const PairNode* tb = task.self ? ta : collider.nodes();
      const int j = tb[task.b].first_child();
      if (i < 0 || j < 0) {
        next_tasks.push_back(task);
        continue;
      }
      for (const int a : {i, i + 1})
        for (const int b : {j, j + 1})
          if (overlap(ta[a], tb[b])) next_tasks.push_back({a, b, task.self});
      more = true;
    }
    tasks.swap(next_tasks);
  }
}

template <bool k_some>
void PairFinder::Impl::run_task(const Task& task, const char* changed, FoundPairs& out) const {
  out.vertex_face.clear();
  out.edge_edge.clear();
  const Tree& other = task.self ? cloth : collider;
  const NodePatches* patches = task.self && !skipped.empty() && cloth.patches().built() ? &cloth.patches() : nullptr;
  const auto run = [&]<bool k_self>() {
    const PairWalk<k_some, k_self> walk{
        features,         cloth.nodes(), other.nodes(), cloth.marks(), other.marks(), changed, cloth.elements(),
        other.elements(), want_edges,    self_margin,   patches,       skipped,       out};
    if constexpr (k_self) {
      if (task.b < 0) return walk.within(task.a);
    }
    walk.between(task.a, task.b);
  };
  task.self ? run.template operator()<true>() : run.template operator()<false>();
}

/// Leaves what is wanted, in no more room than it needs.
void PairFinder::Impl::sift(const PairSieve& sieve, FoundPairs& pairs) const {
  const auto is_unwanted_face = [&](std::uint64_t k) { return !sieve(PairKind::k_vertex_face, vertex_face(k)); };
  const auto is_unwanted_edge = [&](std::uint64_t k) { return !sieve(PairKind::k_edge_edge, edge_edge(k)); };
  std::erase_if(pairs.vertex_face, is_unwanted_face);
  std::erase_if(pairs.edge_edge, is_unwanted_edge);
  pairs.vertex_face.shrink_to_fit();
  pairs.edge_edge.shrink_to_fit();
}

PairFinder::PairFinder(int cloth_vertex_count, std::span<const Triangle> cloth_triangles, int collider_vertex_count,
                       std::span<const Triangle> collider_triangles)
    : impl_(new Impl(PairFeatures(cloth_vertex_count, cloth_triangles, collider_vertex_count, collider_triangles))) {}
PairFinder::~PairFinder() = default;
PairFinder::PairFinder(PairFinder&&) noexcept = default;

void PairFinder::set_self_margin(const BoxMargin& self_margin) {
  impl_->self_margin = self_margin;
}

void PairFinder::set_patches(const Adjacency& members) {
  Impl& m = *impl_;
  CHECK(!m.cloth.built());
  std::vector<int>& start = m.patches_of.start;
  start.assign(m.features.cloth.size() + 1, 0);
  for (const int t : members.items) ++start[at(t) + 1];
  for (std::size_t t = 1; t < start.size(); ++t) start[t] += start[t - 1];
  m.patches_of.items.resize(members.items.size());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (int p = 0; p < members.row_count(); ++p)
    for (const int t : members.row(p)) m.patches_of.items[at(next[at(t)]++)] = p;
}

template <class Place>
void PairFinder::build_trees(Place&& place_of) {
  Impl& m = *impl_;
  if (!m.features.cloth.empty()) m.cloth.build(m.features.cloth, place_of, m.patches_of);
  if (!m.features.collider.empty()) m.collider.build(m.features.collider, place_of, {});
  give_back(m.features.cloth, m.features.collider, m.patches_of);  // the trees have them
}

void PairFinder::arrange(std::span<const Vec3> x) {
  CHECK(x.size() == at(impl_->features.vertex_count));
  build_trees([&](int v) -> fcl::Vector3<float> { return x[at(v)].cast<float>(); });
}

void PairFinder::find(std::span<const VertexBox> boxes, bool self, ContactPairs& out, std::span<const char> skipped,
                      const PairSieve& sieve) {
  search(boxes, self, true, {}, skipped, sieve, out);
}

void PairFinder::find_vertex_face(std::span<const VertexBox> boxes, bool self, ContactPairs& out,
                                  const PairSieve& sieve) {
  search(boxes, self, false, {}, {}, sieve, out);
}

void PairFinder::find_changed(std::span<const VertexBox> boxes, bool self, std::span<const char> changed,
                              ContactPairs& out, std::span<const char> skipped, const PairSieve& sieve) {
  CHECK(changed.size() == boxes.size());
  search(boxes, self, true, changed, skipped, sieve, out);
}

/// changed empty: all pairs. Not empty: the boxes of all others are those of the last search.
void PairFinder::search(std::span<const VertexBox> boxes, bool self, bool edges, std::span<const char> changed,
                        std::span<const char> skipped, const PairSieve& sieve, ContactPairs& out) {
  Impl& m = *impl_;
  m.want_edges = edges;
  m.skipped = skipped;
  const PairFeatures& features = m.features;
  m.features.set_boxes(boxes);
  build_trees([&](int v) -> fcl::Vector3<float> {
    const VertexBox& box = boxes[at(v)];
    fcl::Vector3<float> middle;
    for (int k = 0; k < 3; ++k)
      middle[k] = 0.5f * (static_cast<float>(box.lo[at(k)]) - static_cast<float>(box.minus_hi[at(k)]));
    return middle;
  });
  m.refit(changed);

  m.split_tasks(self);
  std::vector<FoundPairs> found(m.tasks.size());
  parallel_tasks(found.size(), [&](std::size_t i) {
    changed.empty() ? m.run_task<false>(m.tasks[i], nullptr, found[i])
                    : m.run_task<true>(m.tasks[i], changed.data(), found[i]);
    if (sieve) m.sift(sieve, found[i]);
  });

  const auto sort = [&](PairSorter& sorter, std::size_t first_count, auto keys_of) {
    sorter.begin(static_cast<int>(first_count));
    for (const FoundPairs& f : found) sorter.add(f.*keys_of);
    sorter.sort();
  };
  parallel_tasks(2, [&](std::size_t task) {
    if (task == 0)
      sort(m.sort_vertex_face, at(features.vertex_count), &FoundPairs::vertex_face);
    else
      sort(m.sort_edge_edge, features.edges.size(), &FoundPairs::edge_edge);
  });
  give_back(found);

  const auto write = [&](PairSorter& sorter, auto stencil_of, std::vector<Stencil>& pairs) {
    const std::span<const std::uint64_t> keys = sorter.sorted();
    if (pairs.capacity() < keys.size()) give_back(pairs);  // so that there are never two of them
    pairs.resize(keys.size());
    parallel_for(keys.size(), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) pairs[i] = stencil_of(keys[i]);
    });
    sorter.give_back();
  };
  write(
      m.sort_vertex_face, [&](std::uint64_t key) { return m.vertex_face(key); }, out.vertex_face);
  write(
      m.sort_edge_edge, [&](std::uint64_t key) { return m.edge_edge(key); }, out.edge_edge);
}

}  // namespace ft
