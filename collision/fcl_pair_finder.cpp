// Candidate pairs through FCL's trees (box trees over triangles, built once, refit in place), walked by our own recursion:
// FCL's virtual traversal takes 2.4 times as long. A pair of triangles whose boxes overlap is reduced to features at once:
// every vertex and every edge is owned by one triangle (its representative), so each pair of features comes up once.
//
// Caution: the trees are built from the first boxes seen, since only then is there a place for every vertex. They decide how
// long a search takes and nothing else: the result is complete for any tree and sorted, so that it depends on boxes alone.
#include <fcl/geometry/bvh/BVH_model.h>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "collision/contact_pairs.h"
#include "collision/pair_sort.h"

namespace ft {
namespace {

using FclBox = fcl::AABB<float>;
using FclNode = fcl::BVNode<FclBox>;
using FclModel = fcl::BVHModel<FclBox>;

constexpr float k_infinity = std::numeric_limits<float>::infinity();
constexpr std::size_t k_task_goal = 256;  // sub-tree pairs that the search is split into
constexpr std::size_t k_block = 4096;

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr VertexBox k_nowhere{{k_infinity, k_infinity, k_infinity}, {-k_infinity, -k_infinity, -k_infinity}};

inline bool valid(const VertexBox& b) { return b.lo[0] <= b.hi[0] && b.lo[1] <= b.hi[1] && b.lo[2] <= b.hi[2]; }

inline VertexBox join(const VertexBox& a, const VertexBox& b) {
  return {{std::min(a.lo[0], b.lo[0]), std::min(a.lo[1], b.lo[1]), std::min(a.lo[2], b.lo[2])},
          {std::max(a.hi[0], b.hi[0]), std::max(a.hi[1], b.hi[1]), std::max(a.hi[2], b.hi[2])}};
}

/// lo and hi are three floats each, one after the other, in both kinds of box. No branches: the outcome is not predictable.
inline bool overlap(const float* a, const float* b) {
#ifdef __SSE__
  // Four lanes from lo, four up to hi; the fourth lane of the comparison is not looked at.
  const __m128 a_lo = _mm_loadu_ps(a), b_lo = _mm_loadu_ps(b);
  const __m128 a_z_hi = _mm_loadu_ps(a + 2), b_z_hi = _mm_loadu_ps(b + 2);
  const __m128 a_hi = _mm_shuffle_ps(a_z_hi, a_z_hi, _MM_SHUFFLE(0, 3, 2, 1));
  const __m128 b_hi = _mm_shuffle_ps(b_z_hi, b_z_hi, _MM_SHUFFLE(0, 3, 2, 1));
  return (_mm_movemask_ps(_mm_and_ps(_mm_cmple_ps(a_lo, b_hi), _mm_cmple_ps(b_lo, a_hi))) & 7) == 7;
#else
  return (a[0] <= b[3]) & (b[0] <= a[3]) & (a[1] <= b[4]) & (b[1] <= a[4]) & (a[2] <= b[5]) & (b[2] <= a[5]);
#endif
}
static_assert(sizeof(VertexBox) == 6 * sizeof(float) && sizeof(FclBox) == 6 * sizeof(float));

inline bool overlap(const VertexBox& a, const VertexBox& b) { return overlap(a.lo.data(), b.lo.data()); }
inline bool overlap(const FclBox& a, const FclBox& b) { return overlap(a.min_.data(), b.min_.data()); }

// BVNodeBase::isLeaf and its like are calls into FCL's library; the fields are public.
inline bool is_leaf(const FclNode& node) { return node.first_child < 0; }
inline std::size_t leaf_element(const FclNode& node) { return static_cast<std::size_t>(-(node.first_child + 1)); }

/// A triangle as the search sees it. Features are written in turn; counts say how many of them are owned.
struct Element {
  Triangle v;
  int face = 0;                      ///< rank of the face among all faces in lexicographic order; -1: a repetition
  std::array<int, 3> owned_vertex;
  std::array<int, 3> owned_edge;     ///< ranks of edges among all edges in lexicographic order
  std::array<std::uint8_t, 2> owned_count{};  ///< vertices, edges
};

/// One surface: its tree and the elements in the tree's order.
struct Tree {
  FclModel model;
  std::vector<Element> elements;  ///< in the order of the surface's triangles
  std::span<FclNode> nodes;

  bool empty() const { return elements.empty(); }

  void build(std::span<const VertexBox> boxes) {
    std::vector<fcl::Vector3<float>> points;
    std::vector<fcl::Triangle> faces;
    points.reserve(3 * elements.size());
    for (const Element& e : elements) {
      for (const int v : e.v) {
        const VertexBox& b = boxes[at(v)];
        fcl::Vector3<float> p;
        for (int i = 0; i < 3; ++i) {
          const float middle = 0.5f * (b.lo[at(i)] + b.hi[at(i)]);
          p[i] = std::isfinite(middle) ? middle : 0.0f;
        }
        points.push_back(p);
      }
      const std::size_t first = points.size() - 3;
      faces.emplace_back(first, first + 1, first + 2);
    }
    CHECK(model.beginModel(static_cast<int>(faces.size()), static_cast<int>(points.size())) == fcl::BVH_OK);
    CHECK(model.addSubModel(points, faces) == fcl::BVH_OK);
    CHECK(model.endModel() == fcl::BVH_OK);
    nodes = {&model.getBV(0), at(model.getNumBVs())};
  }

  /// Children lie behind their parents, so one pass backwards sees them first.
  void refit(std::span<const VertexBox> face_boxes) {
    for (std::size_t k = nodes.size(); k-- > 0;) {
      FclNode& node = nodes[k];
      if (is_leaf(node)) {
        const VertexBox& b = face_boxes[leaf_element(node)];
        node.bv.min_ = {b.lo[0], b.lo[1], b.lo[2]};
        node.bv.max_ = {b.hi[0], b.hi[1], b.hi[2]};
      } else {
        const FclBox& l = nodes[at(node.first_child)].bv;
        const FclBox& r = nodes[at(node.first_child + 1)].bv;
        node.bv.min_ = l.min_.cwiseMin(r.min_);
        node.bv.max_ = l.max_.cwiseMax(r.max_);
      }
    }
  }
};

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

struct PairFinder::Impl {
  int cloth_vertex_count = 0, vertex_count = 0;
  Tree cloth, collider;
  std::vector<Triangle> faces;  ///< by rank
  std::vector<Edge> edges;      ///< by rank
  bool built = false;

  // Scratch, kept from search to search.
  struct Task {
    int a, b;  ///< nodes; b -1: a against itself
    bool self;
  };
  struct Found {
    std::vector<std::uint64_t> vertex_face, edge_edge;
  };
  std::vector<VertexBox> vertex_boxes, edge_boxes, face_boxes, cloth_leaves, collider_leaves;
  std::vector<Task> tasks, next_tasks;
  std::vector<Found> found;
  PairSorter sorter;

  void number_features(std::span<const Triangle> cloth_triangles, std::span<const Triangle> collider_triangles);
  void make_boxes(std::span<const VertexBox> boxes);
  void split_tasks(bool self);
  void run_task(const Task& task, Found& out) const;
  void walk_self(int n, Found& out) const;
  void walk_pair(const FclNode* ta, const FclNode* tb, int a, int b, const Element* ea, const Element* eb, Found& out) const;
  void meet(const Element& a, const Element& b, Found& out) const;
};

void PairFinder::Impl::number_features(std::span<const Triangle> cloth_triangles,
                                       std::span<const Triangle> collider_triangles) {
  std::vector<Triangle> all(cloth_triangles.begin(), cloth_triangles.end());
  all.insert(all.end(), collider_triangles.begin(), collider_triangles.end());
  faces = all;
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  edges = unique_edges(all);
  std::erase_if(edges, [](const Edge& e) { return e[0] == e[1]; });

  std::vector<char> face_owned(faces.size()), edge_owned(edges.size()), vertex_owned(at(vertex_count));
  const auto take = [](std::vector<char>& owned, std::size_t i) { return owned[i] ? false : (owned[i] = 1, true); };
  for (std::size_t k = 0; k < all.size(); ++k) {
    Element e;
    e.v = all[k];
    const auto face = static_cast<std::size_t>(std::lower_bound(faces.begin(), faces.end(), e.v) - faces.begin());
    e.face = take(face_owned, face) ? static_cast<int>(face) : -1;
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(e.v[i] >= 0 && e.v[i] < vertex_count);
      CHECK((k < cloth_triangles.size()) == (e.v[i] < cloth_vertex_count));
      if (take(vertex_owned, at(e.v[i]))) e.owned_vertex[e.owned_count[0]++] = e.v[i];
      const auto [lo, hi] = std::minmax(e.v[i], e.v[(i + 1) % 3]);
      if (lo == hi) continue;
      const auto edge = static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), Edge{lo, hi}) - edges.begin());
      if (take(edge_owned, edge)) e.owned_edge[e.owned_count[1]++] = static_cast<int>(edge);
    }
    (k < cloth_triangles.size() ? cloth : collider).elements.push_back(e);
  }
}

void PairFinder::Impl::make_boxes(std::span<const VertexBox> boxes) {
  vertex_boxes.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) vertex_boxes[i] = valid(boxes[i]) ? boxes[i] : k_nowhere;
  // A feature with a vertex that is nowhere is nowhere.
  const auto both = [](const VertexBox& a, const VertexBox& b) { return valid(a) && valid(b) ? join(a, b) : k_nowhere; };
  edge_boxes.resize(edges.size());
  parallel_for(edges.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) edge_boxes[i] = both(vertex_boxes[at(edges[i][0])], vertex_boxes[at(edges[i][1])]);
  });
  face_boxes.resize(faces.size());
  parallel_for(faces.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const VertexBox ab = both(vertex_boxes[at(faces[i][0])], vertex_boxes[at(faces[i][1])]);
      face_boxes[i] = both(ab, vertex_boxes[at(faces[i][2])]);
    }
  });
  // A leaf holds all that its triangle may own: also the edge of a triangle whose third vertex is nowhere.
  const auto leaves = [&](const Tree& tree, std::vector<VertexBox>& out) {
    out.resize(tree.elements.size());
    parallel_for(out.size(), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Triangle& v = tree.elements[i].v;
        out[i] = join(join(vertex_boxes[at(v[0])], vertex_boxes[at(v[1])]), vertex_boxes[at(v[2])]);
      }
    });
  };
  leaves(cloth, cloth_leaves);
  leaves(collider, collider_leaves);
}

/// Tasks depend on trees and boxes only. Every round replaces a task by those of its children.
void PairFinder::Impl::split_tasks(bool self) {
  tasks.clear();
  if (cloth.empty()) return;
  if (!collider.empty() && overlap(cloth.nodes[0].bv, collider.nodes[0].bv)) tasks.push_back({0, 0, false});
  if (self) tasks.push_back({0, -1, true});
  for (bool more = true; more && tasks.size() < k_task_goal;) {
    more = false;
    next_tasks.clear();
    for (const Task& task : tasks) {
      const FclNode& a = cloth.nodes[at(task.a)];
      if (task.b < 0) {
        if (is_leaf(a)) continue;
        const int l = a.first_child, r = a.first_child + 1;
        next_tasks.push_back({l, -1, true});
        next_tasks.push_back({r, -1, true});
        if (overlap(cloth.nodes[at(l)].bv, cloth.nodes[at(r)].bv)) next_tasks.push_back({l, r, true});
        more = true;
        continue;
      }
      const Tree& tb = task.self ? cloth : collider;
      const FclNode& b = tb.nodes[at(task.b)];
      if (is_leaf(a) || is_leaf(b)) {
        next_tasks.push_back(task);
        continue;
      }
      for (const int i : {a.first_child, a.first_child + 1})
        for (const int j : {b.first_child, b.first_child + 1})
          if (overlap(cloth.nodes[at(i)].bv, tb.nodes[at(j)].bv)) next_tasks.push_back({i, j, task.self});
      more = true;
    }
    tasks.swap(next_tasks);
  }
}

void PairFinder::Impl::run_task(const Task& task, Found& out) const {
  out.vertex_face.clear();
  out.edge_edge.clear();
  if (task.b < 0) {
    walk_self(task.a, out);
  } else {
    const Tree& other = task.self ? cloth : collider;
    walk_pair(cloth.nodes.data(), other.nodes.data(), task.a, task.b, cloth.elements.data(), other.elements.data(), out);
  }
}

void PairFinder::Impl::walk_self(int n, Found& out) const {
  const FclNode& node = cloth.nodes[at(n)];
  if (is_leaf(node)) return;
  const int l = node.first_child, r = node.first_child + 1;
  walk_self(l, out);
  walk_self(r, out);
  if (overlap(cloth.nodes[at(l)].bv, cloth.nodes[at(r)].bv)) walk_pair(cloth.nodes.data(), cloth.nodes.data(), l, r, cloth.elements.data(), cloth.elements.data(), out);
}

/// a and b overlap. Both sides descend together: the trees are alike, and four tests in a row cost less than two visits.
void PairFinder::Impl::walk_pair(const FclNode* ta, const FclNode* tb, int a, int b, const Element* ea, const Element* eb,
                                 Found& out) const {
  const FclNode& na = ta[a];
  const FclNode& nb = tb[b];
  const int i = na.first_child, j = nb.first_child;
  if (i < 0 && j < 0) {
    meet(ea[leaf_element(na)], eb[leaf_element(nb)], out);
  } else if (j < 0) {
    if (overlap(ta[i].bv, nb.bv)) walk_pair(ta, tb, i, b, ea, eb, out);
    if (overlap(ta[i + 1].bv, nb.bv)) walk_pair(ta, tb, i + 1, b, ea, eb, out);
  } else if (i < 0) {
    if (overlap(na.bv, tb[j].bv)) walk_pair(ta, tb, a, j, ea, eb, out);
    if (overlap(na.bv, tb[j + 1].bv)) walk_pair(ta, tb, a, j + 1, ea, eb, out);
  } else {
    if (overlap(ta[i].bv, tb[j].bv)) walk_pair(ta, tb, i, j, ea, eb, out);
    if (overlap(ta[i].bv, tb[j + 1].bv)) walk_pair(ta, tb, i, j + 1, ea, eb, out);
    if (overlap(ta[i + 1].bv, tb[j].bv)) walk_pair(ta, tb, i + 1, j, ea, eb, out);
    if (overlap(ta[i + 1].bv, tb[j + 1].bv)) walk_pair(ta, tb, i + 1, j + 1, ea, eb, out);
  }
}

/// The features that a pair of triangles is responsible for.
void PairFinder::Impl::meet(const Element& a, const Element& b, Found& out) const {
  const auto vertices_against_face = [&](const Element& p, const Element& f) {
    if (f.face < 0) return;
    const VertexBox& face_box = face_boxes[at(f.face)];
    for (std::size_t i = 0; i < p.owned_count[0]; ++i) {
      const int v = p.owned_vertex[i];
      if (overlap(vertex_boxes[at(v)], face_box) && v != f.v[0] && v != f.v[1] && v != f.v[2])
        out.vertex_face.push_back(pair_key(v, f.face));
    }
  };
  vertices_against_face(a, b);
  vertices_against_face(b, a);
  for (std::size_t i = 0; i < a.owned_count[1]; ++i) {
    const int ea = a.owned_edge[i];
    const VertexBox& box = edge_boxes[at(ea)];
    for (std::size_t j = 0; j < b.owned_count[1]; ++j) {
      const int eb = b.owned_edge[j];
      if (!overlap(box, edge_boxes[at(eb)])) continue;
      const Edge& va = edges[at(ea)];
      const Edge& vb = edges[at(eb)];
      if (va[0] == vb[0] || va[0] == vb[1] || va[1] == vb[0] || va[1] == vb[1]) continue;
      out.edge_edge.push_back(ea < eb ? pair_key(ea, eb) : pair_key(eb, ea));
    }
  }
}

PairFinder::PairFinder(int cloth_vertex_count, std::span<const Triangle> cloth_triangles, int collider_vertex_count,
                       std::span<const Triangle> collider_triangles)
    : impl_(std::make_unique<Impl>()) {
  impl_->cloth_vertex_count = cloth_vertex_count;
  impl_->vertex_count = cloth_vertex_count + collider_vertex_count;
  impl_->number_features(cloth_triangles, collider_triangles);
}
PairFinder::~PairFinder() = default;
PairFinder::PairFinder(PairFinder&&) noexcept = default;

void PairFinder::find(std::span<const VertexBox> boxes, bool self, ContactPairs& out) {
  Impl& m = *impl_;
  CHECK(boxes.size() == at(m.vertex_count));
  m.make_boxes(boxes);
  if (!m.built) {
    if (!m.cloth.empty()) m.cloth.build(boxes);
    if (!m.collider.empty()) m.collider.build(boxes);
    m.built = true;
  }
  m.cloth.refit(m.cloth_leaves);
  m.collider.refit(m.collider_leaves);
  m.split_tasks(self);

  if (m.found.size() < m.tasks.size()) m.found.resize(m.tasks.size());
  parallel_tasks(m.tasks.size(), [&](std::size_t i) { m.run_task(m.tasks[i], m.found[i]); });

  const std::span<const Impl::Found> found(m.found.data(), m.tasks.size());
  m.sorter.begin(m.vertex_count);
  for (const auto& f : found) m.sorter.add(f.vertex_face);
  const auto vertex_face = m.sorter.sort();
  out.vertex_face.resize(vertex_face.size());
  parallel_for(vertex_face.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& f = m.faces[at(key_second(vertex_face[i]))];
      out.vertex_face[i] = {{key_first(vertex_face[i]), f[0], f[1], f[2]}};
    }
  });
  m.sorter.begin(static_cast<int>(m.edges.size()));
  for (const auto& f : found) m.sorter.add(f.edge_edge);
  const auto edge_edge = m.sorter.sort();
  out.edge_edge.resize(edge_edge.size());
  parallel_for(edge_edge.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Edge& a = m.edges[at(key_first(edge_edge[i]))];
      const Edge& b = m.edges[at(key_second(edge_edge[i]))];
      out.edge_edge[i] = {{a[0], a[1], b[0], b[1]}};
    }
  });
}

}  // namespace ft
