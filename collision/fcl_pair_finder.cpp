// Candidate pairs through FCL's trees (box trees over triangles, built once, refit in place), walked by our own
// recursion: FCL's virtual traversal takes 2.4 times as long. A pair of triangles whose boxes overlap is reduced to
// features at once: every vertex and every edge is owned by one triangle, so each pair of features comes up once.
//
// Caution: the trees are built from the first boxes seen, since only then is there a place for every vertex. They
// decide how long a search takes and nothing else: the result is complete for any tree and sorted, so it depends on
// boxes alone.
#include <fcl/geometry/bvh/BVH_model.h>

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "collision/contact_pairs.h"
#include "collision/pair_features.h"
#include "collision/pair_sort.h"

namespace ft {
namespace {

using FclBox = fcl::AABB<float>;
using FclNode = fcl::BVNode<FclBox>;

constexpr std::size_t k_task_goal = 256;  // sub-tree pairs that the search is split into
constexpr std::size_t k_block = 4096;

static_assert(sizeof(FclBox) == 6 * sizeof(float));
inline bool overlap(const FclBox& a, const FclBox& b) {
  return boxes_overlap(a.min_.data(), b.min_.data());
}

// BVNodeBase::isLeaf and its like are calls into FCL's library; the fields are public.
inline bool is_leaf(const FclNode& node) {
  return node.first_child < 0;
}
inline std::size_t leaf_element(const FclNode& node) {
  return static_cast<std::size_t>(-(node.first_child + 1));
}

/// The tree of one surface; leaves are its elements.
class Tree {
 public:
  bool built() const { return !nodes_.empty(); }
  const FclNode* nodes() const { return nodes_.data(); }
  /// Per node: whether an element below it was among those of mark().
  const char* marks() const { return marks_.data(); }

  void build(std::span<const PairElement> elements, std::span<const VertexBox> vertex_boxes) {
    std::vector<fcl::Vector3<float>> points;
    std::vector<fcl::Triangle> faces;
    points.reserve(3 * elements.size());
    for (const PairElement& e : elements) {
      const std::size_t first = points.size();
      for (const int v : e.v) {
        const VertexBox& b = vertex_boxes[at(v)];
        fcl::Vector3<float>& p = points.emplace_back();
        for (int i = 0; i < 3; ++i) {
          const float middle = 0.5f * (b.lo[at(i)] + b.hi[at(i)]);
          p[i] = std::isfinite(middle) ? middle : 0.0f;  // who is nowhere has no middle
        }
      }
      faces.emplace_back(first, first + 1, first + 2);
    }
    CHECK(model_.beginModel(static_cast<int>(faces.size()), static_cast<int>(points.size())) == fcl::BVH_OK);
    CHECK(model_.addSubModel(points, faces) == fcl::BVH_OK);
    CHECK(model_.endModel() == fcl::BVH_OK);
    nodes_ = {&model_.getBV(0), at(model_.getNumBVs())};
  }

  void mark(std::span<const PairElement> elements, std::span<const char> changed) {
    marks_.resize(nodes_.size());
    for (std::size_t k = nodes_.size(); k-- > 0;) {
      const FclNode& node = nodes_[k];
      const auto of_element = [&](const Triangle& v) {
        return changed[at(v[0])] | changed[at(v[1])] | changed[at(v[2])];
      };
      marks_[k] = static_cast<char>(is_leaf(node) ? of_element(elements[leaf_element(node)].v)
                                                  : marks_[at(node.first_child)] | marks_[at(node.first_child + 1)]);
    }
  }

  /// Children lie behind their parents, so one pass backwards sees them first.
  void refit(std::span<const VertexBox> element_boxes) {
    for (std::size_t k = nodes_.size(); k-- > 0;) {
      FclNode& node = nodes_[k];
      if (is_leaf(node)) {
        const VertexBox& b = element_boxes[leaf_element(node)];
        node.bv.min_ = {b.lo[0], b.lo[1], b.lo[2]};
        node.bv.max_ = {b.hi[0], b.hi[1], b.hi[2]};
      } else {
        const FclBox& l = nodes_[at(node.first_child)].bv;
        const FclBox& r = nodes_[at(node.first_child + 1)].bv;
        node.bv.min_ = l.min_.cwiseMin(r.min_);
        node.bv.max_ = l.max_.cwiseMax(r.max_);
      }
    }
  }

 private:
  fcl::BVHModel<FclBox> model_;
  std::span<FclNode> nodes_;
  std::vector<char> marks_;
};

/// Keys of feature pairs (pair_sort.h), by rank.
struct Found {
  std::vector<std::uint64_t> vertex_face, edge_edge;
};

/// Walks two trees, or one against itself, and writes down the feature pairs of leaves that overlap. k_some: only those
/// with a changed vertex.
template <bool k_some>
struct Walk {
  const PairFeatures& features;
  const FclNode *ta, *tb;
  const char *ma, *mb;  ///< marks of the trees
  const char* changed;  ///< per vertex
  const PairElement *ea, *eb;
  bool want_edges;
  Found& out;

  bool meets(int a, int b) const {
    if (k_some && !(ma[a] | mb[b])) return false;
    return overlap(ta[a].bv, tb[b].bv);
  }

  /// All pairs below node n of ta, which is tb.
  void within(int n) const {
    const int i = ta[n].first_child;
    if (i < 0 || (k_some && !ma[n])) return;
    within(i);
    within(i + 1);
    if (meets(i, i + 1)) between(i, i + 1);
  }

  /// a and b overlap. Both sides descend together: four tests in a row cost less than two visits.
  void between(int a, int b) const {
    const FclNode& na = ta[a];
    const FclNode& nb = tb[b];
    const int i = na.first_child, j = nb.first_child;
    if (i < 0 && j < 0) {
      meet(ea[leaf_element(na)], eb[leaf_element(nb)]);
    } else if (j < 0) {
      if (meets(i, b)) between(i, b);
      if (meets(i + 1, b)) between(i + 1, b);
    } else if (i < 0) {
      if (meets(a, j)) between(a, j);
      if (meets(a, j + 1)) between(a, j + 1);
    } else {
      if (meets(i, j)) between(i, j);
      if (meets(i, j + 1)) between(i, j + 1);
      if (meets(i + 1, j)) between(i + 1, j);
      if (meets(i + 1, j + 1)) between(i + 1, j + 1);
    }
  }

  /// The feature pairs that a pair of triangles is responsible for.
  void meet(const PairElement& a, const PairElement& b) const {
    vertices_against_face(a, b);
    vertices_against_face(b, a);
    if (!want_edges) return;
    for (int i = 0; i < a.owned_edge_count; ++i) {
      const int ra = a.owned_edge[at(i)];
      const VertexBox& box = features.edge_boxes[at(ra)];
      for (int j = 0; j < b.owned_edge_count; ++j) {
        const int rb = b.owned_edge[at(j)];
        if (!overlap(box, features.edge_boxes[at(rb)])) continue;
        const Edge &va = features.edges[at(ra)], &vb = features.edges[at(rb)];
        if (va[0] == vb[0] || va[0] == vb[1] || va[1] == vb[0] || va[1] == vb[1]) continue;
        if (k_some && !(changed[va[0]] | changed[va[1]] | changed[vb[0]] | changed[vb[1]])) continue;
        out.edge_edge.push_back(ra < rb ? pair_key(ra, rb) : pair_key(rb, ra));
      }
    }
  }

  void vertices_against_face(const PairElement& p, const PairElement& f) const {
    if (f.face < 0) return;
    const VertexBox& face_box = features.face_boxes[at(f.face)];
    for (int i = 0; i < p.owned_vertex_count; ++i) {
      const int v = p.owned_vertex[at(i)];
      if (!overlap(features.vertex_boxes[at(v)], face_box) || v == f.v[0] || v == f.v[1] || v == f.v[2]) continue;
      if (k_some && !(changed[v] | changed[f.v[0]] | changed[f.v[1]] | changed[f.v[2]])) continue;
      out.vertex_face.push_back(pair_key(v, f.face));
    }
  }
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
  bool want_edges = true;
  Tree cloth, collider;

  // Scratch, kept from search to search.
  std::vector<Task> tasks, next_tasks;
  std::vector<Found> found;
  PairSorter sort_vertex_face, sort_edge_edge;

  void split_tasks(bool self);
  template <bool k_some>
  void run_task(const Task& task, const char* changed, Found& out) const;
};

/// Tasks depend on trees and boxes only, never on threads. Every round replaces a task by those of its children.
void PairFinder::Impl::split_tasks(bool self) {
  tasks.clear();
  if (!cloth.built()) return;
  const FclNode* ta = cloth.nodes();
  if (collider.built() && overlap(ta[0].bv, collider.nodes()[0].bv)) tasks.push_back({0, 0, false});
  if (self) tasks.push_back({0, -1, true});
  for (bool more = true; more && tasks.size() < k_task_goal;) {
    more = false;
    next_tasks.clear();
    for (const Task& task : tasks) {
      const int i = ta[task.a].first_child;
      if (task.b < 0) {
        if (i < 0) continue;
        next_tasks.push_back({i, -1, true});
        next_tasks.push_back({i + 1, -1, true});
        if (overlap(ta[i].bv, ta[i + 1].bv)) next_tasks.push_back({i, i + 1, true});
        more = true;
        continue;
      }
      const FclNode* tb = task.self ? ta : collider.nodes();
      const int j = tb[task.b].first_child;
      if (i < 0 || j < 0) {
        next_tasks.push_back(task);
        continue;
      }
      for (const int a : {i, i + 1})
        for (const int b : {j, j + 1})
          if (overlap(ta[a].bv, tb[b].bv)) next_tasks.push_back({a, b, task.self});
      more = true;
    }
    tasks.swap(next_tasks);
  }
}

template <bool k_some>
void PairFinder::Impl::run_task(const Task& task, const char* changed, Found& out) const {
  out.vertex_face.clear();
  out.edge_edge.clear();
  const Tree& other = task.self ? cloth : collider;
  const PairElement* other_elements = task.self ? features.cloth.data() : features.collider.data();
  const Walk<k_some> walk{features, cloth.nodes(),         other.nodes(),  cloth.marks(), other.marks(),
                          changed,  features.cloth.data(), other_elements, want_edges,    out};
  task.b < 0 ? walk.within(task.a) : walk.between(task.a, task.b);
}

PairFinder::PairFinder(int cloth_vertex_count, std::span<const Triangle> cloth_triangles, int collider_vertex_count,
                       std::span<const Triangle> collider_triangles)
    : impl_(new Impl(PairFeatures(cloth_vertex_count, cloth_triangles, collider_vertex_count, collider_triangles))) {}
PairFinder::~PairFinder() = default;
PairFinder::PairFinder(PairFinder&&) noexcept = default;

void PairFinder::find(std::span<const VertexBox> boxes, bool self, ContactPairs& out) {
  search(boxes, self, true, {}, out);
}

void PairFinder::find_vertex_face(std::span<const VertexBox> boxes, bool self, ContactPairs& out) {
  search(boxes, self, false, {}, out);
}

void PairFinder::find_changed(std::span<const VertexBox> boxes, bool self, std::span<const char> changed,
                              ContactPairs& out) {
  CHECK(changed.size() == boxes.size());
  search(boxes, self, true, changed, out);
}

/// changed empty: all pairs.
void PairFinder::search(std::span<const VertexBox> boxes, bool self, bool edges, std::span<const char> changed,
                        ContactPairs& out) {
  Impl& m = *impl_;
  m.want_edges = edges;
  const PairFeatures& features = m.features;
  m.features.set_boxes(boxes);
  if (!m.cloth.built() && !features.cloth.empty()) m.cloth.build(features.cloth, features.vertex_boxes);
  if (!m.collider.built() && !features.collider.empty()) m.collider.build(features.collider, features.vertex_boxes);
  parallel_tasks(2, [&](std::size_t task) {
    Tree& tree = task == 0 ? m.cloth : m.collider;
    tree.refit(task == 0 ? features.cloth_boxes : features.collider_boxes);
    if (!changed.empty()) tree.mark(task == 0 ? features.cloth : features.collider, changed);
  });

  m.split_tasks(self);
  if (m.found.size() < m.tasks.size()) m.found.resize(m.tasks.size());
  if (changed.empty()) {
    parallel_tasks(m.tasks.size(), [&](std::size_t i) { m.run_task<false>(m.tasks[i], nullptr, m.found[i]); });
  } else {
    parallel_tasks(m.tasks.size(), [&](std::size_t i) { m.run_task<true>(m.tasks[i], changed.data(), m.found[i]); });
  }
  const std::span<const Found> found(m.found.data(), m.tasks.size());

  const auto write = [&](PairSorter& sorter, std::size_t first_count, auto keys_of, auto stencil_of, auto& pairs) {
    sorter.begin(static_cast<int>(first_count));
    for (const Found& f : found) sorter.add(f.*keys_of);
    const std::span<const std::uint64_t> keys = sorter.sort();
    pairs.resize(keys.size());
    parallel_for(keys.size(), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) pairs[i] = stencil_of(key_first(keys[i]), key_second(keys[i]));
    });
  };
  const auto vertex_face = [&](int v, int face) {
    const Triangle& f = features.faces[at(face)];
    return Stencil{{v, f[0], f[1], f[2]}};
  };
  const auto edge_edge = [&](int first, int second) {
    const Edge &a = features.edges[at(first)], &b = features.edges[at(second)];
    return Stencil{{a[0], a[1], b[0], b[1]}};
  };
  parallel_tasks(2, [&](std::size_t task) {
    if (task == 0)
      write(m.sort_vertex_face, at(features.vertex_count), &Found::vertex_face, vertex_face, out.vertex_face);
    else
      write(m.sort_edge_edge, features.edges.size(), &Found::edge_edge, edge_edge, out.edge_edge);
  });
}

}  // namespace ft
