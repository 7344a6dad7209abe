// Candidate pairs through box trees over triangles (pair_tree.h), arranged once, refitted in place and walked by our
// own recursion: FCL's virtual traversal takes 2.4 times as long. A pair of triangles whose boxes overlap is reduced to
// features at once: every vertex and every edge is owned by one triangle, so each pair of features comes up once.
//
// Caution: the trees are arranged for the first places or boxes seen, since only then is there a place for every
// vertex. They decide how long a search takes and nothing else: the result is complete for any tree and sorted, so it
// depends on boxes alone.
#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "collision/contact_pairs.h"
#include "collision/pair_tree.h"
#include "collision/pair_walk.h"

namespace ft {
namespace {

constexpr std::size_t k_task_goal = 256;  // sub-tree pairs that the search is split into
constexpr std::size_t k_block = 4096;

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
    const Edge &a = features.edge(key_first(key)), &b = features.edge(key_second(key));
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
void PairFinder::Impl::sift(const PairSieve& sieve, FoundPairs& pairs) const {
  const auto is_unwanted_face = [&](std::uint64_t k) { return !sieve(PairKind::k_vertex_face, vertex_face(k)); };
  const auto is_unwanted_edge = [&](std::uint64_t k) { return !sieve(PairKind::k_edge_edge, edge_edge(k)); };
  std::erase_if(pairs.vertex_face, is_unwanted_face);
  std::erase_if(pairs.edge_edge, is_unwanted_edge);
  pairs.vertex_face.shrink_to_fit();
  pairs.edge_edge.shrink_to_fit();
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
  if (!m.features.cloth.empty()) m.cloth.build(m.features.cloth, place_of, m.patches_of);
  if (!m.features.collider.empty()) m.collider.build(m.features.collider, place_of, {});
  give_back(m.features.cloth, m.features.collider, m.patches_of);  // the trees have them
}

void PairFinder::arrange(std::span<const Vec3> x) {
  CHECK(x.size() == at(impl_->features.vertex_count));
  build_trees([&](int v) { return x[at(v)].cast<float>(); });
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
  build_trees([&](int v) -> Vec3f {
    const VertexBox& box = boxes[at(v)];
    Vec3f middle;
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
      sort(m.sort_edge_edge, features.edge_count(), &FoundPairs::edge_edge);
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
