// Candidate pairs through box trees over triangles (pair_tree.h), arranged once, refitted in place and walked by our
// own recursion: FCL's virtual traversal takes 2.4 times as long. A pair of triangles whose boxes overlap is reduced to
// features at once: every vertex and every edge is owned by one triangle, so each pair of features comes up once.
//
// Caution: the trees are arranged for the first places or boxes seen, since only then is there a place for every
// vertex. They decide how long a search takes and nothing else: the result is complete for any tree and sorted, so it
// depends on boxes alone.
#include "collision/broad_phase/pair_finder.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "collision/broad_phase/pair_sort.h"
#include "collision/broad_phase/pair_tree.h"
#include "collision/broad_phase/pair_walk.h"

namespace ft::inline collision {
namespace {

constexpr std::size_t k_task_goal = 256;  // sub-tree pairs that the search is split into

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
  PairTree cloth, collider;

  // Scratch, kept from search to search.
  std::vector<Task> tasks, next_tasks;

  void refit(std::span<const char> changed);
  void split_tasks(bool self);
  template <bool k_some>
  void run_task(const Task& task, const char* changed, PairKeys& out) const;
  void sift(const PairSieve& sieve, PairKeys& pairs) const;
};

void PairFinder::Impl::refit(std::span<const char> changed) {
  parallel_tasks(2, [&](std::size_t task) { (task == 0 ? cloth : collider).begin_refit(features, changed); });
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
void PairFinder::Impl::run_task(const Task& task, const char* changed, PairKeys& out) const {
  out.vertex_face.clear();
  out.edge_edge.clear();
  const PairTree& other = task.self ? cloth : collider;
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
void PairFinder::Impl::sift(const PairSieve& sieve, PairKeys& pairs) const {
  const FeatureNumbers numbers = features.numbers();
  const auto sift_kind = [&](PairKind kind, std::vector<PairKey>& keys) {
    std::erase_if(keys, [&](PairKey key) { return !sieve(kind, numbers.stencil(kind, key)); });
    keys.shrink_to_fit();
  };
  sift_kind(PairKind::k_vertex_face, pairs.vertex_face);
  sift_kind(PairKind::k_edge_edge, pairs.edge_edge);
}

PairFinder::PairFinder(int cloth_vertex_count, std::span<const Triangle> cloth_triangles, int collider_vertex_count,
                       std::span<const Triangle> collider_triangles, std::span<const Edge> known_edges)
    : impl_(new Impl(
          PairFeatures(cloth_vertex_count, cloth_triangles, collider_vertex_count, collider_triangles, known_edges))) {}
PairFinder::~PairFinder() = default;
PairFinder::PairFinder(PairFinder&&) noexcept = default;

void PairFinder::set_self_margin(const BoxMargin& self_margin) {
  impl_->self_margin = self_margin;
}

void PairFinder::set_patches(const AscendingRows& members) {
  Impl& m = *impl_;
  CHECK(!m.cloth.built());
  std::vector<int>& start = m.patches_of.start;
  start.assign(m.features.cloth.size() + 1, 0);
  for (int p = 0; p < members.row_count(); ++p) members.for_each(p, [&](int t) { ++start[at(t) + 1]; });
  for (std::size_t t = 1; t < start.size(); ++t) start[t] += start[t - 1];
  m.patches_of.items.resize(at(start.back()));
  std::vector<int> next(start.begin(), start.end() - 1);
  for (int p = 0; p < members.row_count(); ++p)
    members.for_each(p, [&](int t) { m.patches_of.items[at(next[at(t)]++)] = p; });
}

void PairFinder::build_trees(const std::function<Vec3f(int)>& place_of) {
  Impl& m = *impl_;
  if (!m.features.cloth.empty()) m.cloth.build(m.features.cloth, m.features, place_of, m.patches_of);
  if (!m.features.collider.empty()) m.collider.build(m.features.collider, m.features, place_of, {});
  give_back(m.features.cloth, m.features.collider, m.patches_of);  // the trees have them
}

void PairFinder::arrange(std::span<const Vec3> x) {
  CHECK(x.size() == at(impl_->features.vertex_count));
  build_trees([&](int v) { return x[at(v)].cast<float>(); });
}

void PairFinder::find(std::span<const VertexBox> boxes, bool self, PairList& out, std::span<const char> skipped,
                      const PairSieve& sieve) {
  search(boxes, self, true, {}, skipped, sieve, out);
}

void PairFinder::find_vertex_face(std::span<const VertexBox> boxes, bool self, PairList& out, const PairSieve& sieve) {
  search(boxes, self, false, {}, {}, sieve, out);
}

void PairFinder::find_changed(std::span<const VertexBox> boxes, bool self, std::span<const char> changed, PairList& out,
                              std::span<const char> skipped, const PairSieve& sieve) {
  CHECK(changed.size() == boxes.size());
  search(boxes, self, true, changed, skipped, sieve, out);
}

/// changed empty: all pairs. Not empty: the boxes of all others are those of the last search.
void PairFinder::search(std::span<const VertexBox> boxes, bool self, bool edges, std::span<const char> changed,
                        std::span<const char> skipped, const PairSieve& sieve, PairList& out) {
  Impl& m = *impl_;
  m.want_edges = edges;
  m.skipped = skipped;
  const PairFeatures& features = m.features;
  m.features.set_boxes(boxes);
  give_back(out.vertex_face, out.edge_edge);  // their room is needed for the search
  out.features = features.numbers();
  build_trees([&](int v) -> Vec3f {
    const VertexBox& box = boxes[at(v)];
    Vec3f middle;
    for (int k = 0; k < 3; ++k)
      middle[k] = 0.5f * (static_cast<float>(box.lo[at(k)]) - static_cast<float>(box.minus_hi[at(k)]));
    return middle;
  });
  m.refit(changed);

  m.split_tasks(self);
  std::vector<PairKeys> found(m.tasks.size());
  parallel_tasks(found.size(), [&](std::size_t i) {
    changed.empty() ? m.run_task<false>(m.tasks[i], nullptr, found[i])
                    : m.run_task<true>(m.tasks[i], changed.data(), found[i]);
    if (sieve) m.sift(sieve, found[i]);
  });

  const auto sort = [&](std::vector<PairKey> PairKeys::*kind, std::size_t first_count) {
    std::vector<std::span<const PairKey>> parts;
    for (const PairKeys& keys : found) parts.emplace_back(keys.*kind);
    out.*kind = sorted_keys(parts, first_count);
  };
  parallel_tasks(2, [&](std::size_t task) {
    if (task == 0)
      sort(&PairKeys::vertex_face, at(features.vertex_count));
    else
      sort(&PairKeys::edge_edge, features.edge_count());
  });
}

}  // namespace ft::inline collision
