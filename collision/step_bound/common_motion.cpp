#include "collision/step_bound/common_motion.h"

#include <algorithm>

#include "baker/core/check.h"
#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "collision/step_bound/cluster_correction.h"

namespace ft::inline collision {
namespace {

constexpr std::size_t k_block = 1024;  // pairs per block
constexpr int k_most_rounds = 12;      ///< looks at the pairs
constexpr int k_most_joins = 40;       ///< looks after those, after each of which more moves as one
constexpr int k_sweeps = 3;            ///< over the pairs that a look has found
/// Pairs that would use more than their room are left with this share of it, so that they do not come back in the next
/// round for what a neighbour changes, and the rest of the displacement finds some.
constexpr double k_left_in_common = 0.5;

/// How far the displacements go beyond what they may use of the room [m].
double excess(PairKind kind, const PairRoom& room, const std::array<Vec3, 4>& displacement, double floor) {
  return pair_approach(kind, pair_advance(kind, room, displacement)).sum() - may_use(room, floor);
}

/// The cluster that both features have vertices of, -1: none. A cluster has its motion in common: what approaches in it
/// is what its vertices do against that.
int cluster_across(const VertexClusters& clusters, PairKind kind, const Stencil& stencil) {
  const auto split = static_cast<std::size_t>(first_feature_size(kind));
  for (std::size_t i = 0; i < split; ++i)
    for (std::size_t k = split; k < 4; ++k)
      if (const int cluster = clusters.of(stencil.v[i]); cluster >= 0 && clusters.of(stencil.v[k]) == cluster)
        return cluster;
  return -1;
}

}  // namespace

struct CommonMotion::Problem {
  std::span<const Vec3> x, dx;
  std::size_t movable_end;
  double floor;
  const VertexClusters& clusters;
  std::span<Vec3> common;

  bool movable(int v) const { return static_cast<std::size_t>(v) < movable_end; }
};

void CommonMotion::look_at_all(const Problem& problem, const PairView& pairs) {
  tight_.clear();
  look(problem, PairKind::k_vertex_face, pairs);
  look(problem, PairKind::k_edge_edge, pairs);
}

/// Finds the pairs that would come too near, of those with a vertex that has changed.
void CommonMotion::look(const Problem& problem, PairKind kind, const PairView& pairs) {
  const std::size_t count = pairs.count(kind), blocks = block_count(count, k_block);
  if (found_.size() < blocks) found_.resize(blocks);
  parallel_for(count, k_block, [&](std::size_t begin, std::size_t end) {
    std::vector<TightPair>& mine = found_[begin / k_block];
    mine.clear();
    for (std::size_t k = begin; k < end; ++k) {
      const Stencil s = pairs.stencil(kind, k);
      if (std::none_of(s.v.begin(), s.v.end(),
                       [&](int v) { return problem.movable(v) && changed_[static_cast<std::size_t>(v)]; }))
        continue;
      const PairMove move = pair_move(s, problem.x, problem.dx, problem.common, problem.movable_end);
      const double motion = largest_relative_motion(kind, move.common);
      if (!(motion > 0)) continue;
      const double reach = problem.floor + motion / k_truncate_reach;
      if (box_gap_squared(kind, move.x) > reach * reach) continue;
      PairRoom room = pair_room(kind, move.x);
      if (room.gap > 0) {
        double too_much = excess(kind, room, move.common, problem.floor);
        if (too_much <= 0) continue;
        const PairRoom flat = flat_room(kind, move.x);
        if (flat.gap > problem.floor && excess(kind, flat, move.common, problem.floor) < too_much) {
          too_much = excess(kind, flat, move.common, problem.floor);
          if (too_much <= 0) continue;
          room = flat;
        }
        if (slides_past(kind, move, std::max(problem.floor, (1 - k_truncate_reach) * room.gap))) continue;
      }
      mine.push_back({kind, s, room});
    }
  });
  for (std::size_t b = 0; b < blocks; ++b) tight_.insert(tight_.end(), found_[b].begin(), found_[b].end());
}

/// Takes from the displacements of a pair what is too much.
void CommonMotion::relax(const Problem& problem, const TightPair& pair) {
  const std::array<int, 4>& v = pair.stencil.v;
  if (!(pair.room.gap > 0)) {  // no normal separates them: nothing is proved, nothing moves
    for (const int& i : v) {
      if (!problem.movable(i)) continue;
      for (const int j : problem.clusters.with(i)) problem.common[at(j)].setZero(), changing_[at(j)] = 1;
    }
    return;
  }
  std::array<Vec3, 4> motion =
      pair_move(pair.stencil, problem.x, problem.dx, problem.common, problem.movable_end).common;
  if (const int cluster = cluster_across(problem.clusters, pair.kind, pair.stencil); cluster >= 0) {
    const Vec3 mean = problem.clusters.mean(cluster, problem.common);
    for (Vec3& m : motion) m -= mean;
  }
  const std::array<double, 4> advance = pair_advance(pair.kind, pair.room, motion);
  const PairApproach approach = pair_approach(pair.kind, advance);
  const double too_much = approach.sum() - k_left_in_common * may_use(pair.room, problem.floor);
  if (!(too_much > 0)) return;
  const double first = std::max(0.0, approach.first), second = std::max(0.0, approach.second);
  const std::array<double, 4> along = pair_retreat(pair.kind, advance, approach, first / (first + second), too_much);
  for_each_retreat(problem.clusters, pair.kind, pair.stencil, along, [&](int i, double retreat) {
    if (problem.movable(i)) problem.common[at(i)] += retreat * pair.room.normal;
  });
  for (std::size_t k = 0; k < 4; ++k) {
    if (!problem.movable(v[k]) || along[k] == 0) continue;
    for (const int i : problem.clusters.with(v[k])) changing_[at(i)] = 1;
  }
}

/// Shortens what has changed, in a cluster all of it, to what stays in the balls and, in clusters, is no longer than
/// the longest of their dx.
void CommonMotion::stay_inside(const Problem& problem, const MotionBounds& bounds) {
  for (int v = 0; problem.movable(v); ++v) {
    const std::span<const int> together = problem.clusters.with(v);
    if (!changing_[at(v)] || together.front() != v) continue;
    double share = 1;
    if (together.size() > 1) {
      double farthest = 0, longest = 0;
      for (const int i : together) {
        farthest = std::max(farthest, problem.dx[at(i)].norm());
        longest = std::max(longest, problem.common[at(i)].norm());
      }
      if (longest > farthest) share = farthest / longest;
    }
    for (const int i : together) {
      const Vec3& own = problem.common[at(i)];
      if (!bounds.radius.empty())
        share =
            std::min(share, share_inside_ball(problem.x[at(i)] - bounds.centre_of(at(i)), own, bounds.radius[at(i)]));
    }
    for (const int i : together) problem.common[at(i)] *= share;
  }
}

/// Lets the vertices of the pairs that were found move as one, with all that moves as one with them already; not at all
/// where one of them is not movable.
void CommonMotion::join(const Problem& problem, const MotionBounds& bounds) {
  const std::array<Vec3, 4> still{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (const TightPair& pair : tight_) {
    std::array<Vec3, 4> x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = problem.x[at(pair.stencil.v[k])];
    zones_.join(pair.kind, pair.stencil, x, still);
  }
  const std::span<Vec3> common = problem.common.first(problem.movable_end);
  const std::vector<Vec3> before(common.begin(), common.end());
  zones_.apply(common);
  std::vector<double> share(common.size(), 1.0);  // at the root
  for (int v = 0; problem.movable(v); ++v) {
    double& least = share[at(zones_.root(v))];
    const double length = common[at(v)].norm(), wanted = problem.dx[at(v)].norm();
    if (length > wanted) least = std::min(least, wanted / length);
    if (!bounds.radius.empty())
      least = std::min(
          least, share_inside_ball(problem.x[at(v)] - bounds.centre_of(at(v)), common[at(v)], bounds.radius[at(v)]));
  }
  for (int v = 0; problem.movable(v); ++v) {
    common[at(v)] *= share[at(zones_.root(v))];
    changed_[at(v)] = common[at(v)] != before[at(v)];
  }
}

void CommonMotion::find(std::span<const Vec3> x, std::span<const Vec3> dx, int movable_count, const PairView& pairs,
                        double floor, const MotionBounds& bounds, const VertexClusters& clusters,
                        std::span<Vec3> common) {
  const Problem problem{x, dx, at(movable_count), floor, clusters, common};
  CHECK(common.size() >= problem.movable_end && dx.size() >= problem.movable_end && x.size() >= problem.movable_end);
  relax_all(problem, pairs, bounds);
  give_back(changed_, changing_, tight_, found_);  // in folds there are many
}

void CommonMotion::relax_all(const Problem& problem, const PairView& pairs, const MotionBounds& bounds) {
  std::copy_n(problem.dx.begin(), problem.movable_end, problem.common.begin());
  changed_.assign(problem.movable_end, 1);
  for (rounds_ = 1; rounds_ <= k_most_rounds; ++rounds_) {
    look_at_all(problem, pairs);
    if (tight_.empty()) return;
    changing_.assign(problem.movable_end, 0);
    for (int sweep = 0; sweep < k_sweeps; ++sweep)
      for (const TightPair& pair : tight_) relax(problem, pair);
    stay_inside(problem, bounds);
    changed_.swap(changing_);
  }
  zones_.clear(static_cast<int>(problem.movable_end), problem.clusters);
  for (; rounds_ <= k_most_rounds + k_most_joins; ++rounds_) {
    look_at_all(problem, pairs);
    if (tight_.empty()) return;
    join(problem, bounds);
  }
  std::fill_n(problem.common.begin(), problem.movable_end, Vec3::Zero());
}

}  // namespace ft::inline collision
