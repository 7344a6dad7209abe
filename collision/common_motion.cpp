#include "collision/common_motion.h"

#include <algorithm>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft {
namespace {

constexpr std::size_t k_block = 1024;  // pairs per block
constexpr int k_most_rounds = 12;      ///< looks at the pairs
constexpr int k_sweeps = 3;            ///< over the pairs that a look has found
/// Pairs that would use more than their room are left with this share of it, so that they do not come back in the next
/// round for what a neighbour changes, and the rest of the displacement finds some.
constexpr double k_left_in_common = 0.5;

/// How far the displacements go beyond what they may use of the room [m].
double excess(PairKind kind, const PairRoom& room, const std::array<Vec3, 4>& displacement, double floor) {
  return pair_approach(kind, pair_advance(kind, room, displacement)).sum() - may_use(room, floor);
}

}  // namespace

struct CommonMotion::Problem {
  std::span<const Vec3> x, dx;
  std::size_t movable_end;
  double floor;
  std::span<Vec3> common;

  bool movable(int v) const { return static_cast<std::size_t>(v) < movable_end; }
};

/// Finds the pairs that would come too near, of those with a vertex that has changed.
void CommonMotion::look(const Problem& problem, PairKind kind, std::span<const Stencil> stencils) {
  const std::size_t blocks = block_count(stencils.size(), k_block);
  if (found_.size() < blocks) found_.resize(blocks);
  parallel_for(stencils.size(), k_block, [&](std::size_t begin, std::size_t end) {
    std::vector<TightPair>& mine = found_[begin / k_block];
    mine.clear();
    for (std::size_t k = begin; k < end; ++k) {
      const Stencil& s = stencils[k];
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
    for (const int i : v)
      if (problem.movable(i)) problem.common[static_cast<std::size_t>(i)].setZero(), changing_[at(i)] = 1;
    return;
  }
  const std::array<double, 4> advance = pair_advance(
      pair.kind, pair.room, pair_move(pair.stencil, problem.x, problem.dx, problem.common, problem.movable_end).common);
  const PairApproach approach = pair_approach(pair.kind, advance);
  const double too_much = approach.sum() - k_left_in_common * may_use(pair.room, problem.floor);
  if (!(too_much > 0)) return;
  const double first = std::max(0.0, approach.first), second = std::max(0.0, approach.second);
  const std::array<double, 4> along = pair_retreat(pair.kind, advance, approach, first / (first + second), too_much);
  for (std::size_t i = 0; i < 4; ++i) {
    if (!problem.movable(v[i]) || along[i] == 0) continue;
    problem.common[at(v[i])] += along[i] * pair.room.normal;
    changing_[at(v[i])] = 1;
  }
}

void CommonMotion::find(std::span<const Vec3> x, std::span<const Vec3> dx, int movable_count, const ContactPairs& pairs,
                        double floor, const MotionBounds& bounds, std::span<Vec3> common) {
  const Problem problem{x, dx, at(movable_count), floor, common};
  CHECK(common.size() >= problem.movable_end && dx.size() >= problem.movable_end && x.size() >= problem.movable_end);
  std::copy_n(dx.begin(), problem.movable_end, common.begin());
  changed_.assign(problem.movable_end, 1);
  for (rounds_ = 1; rounds_ <= k_most_rounds; ++rounds_) {
    tight_.clear();
    look(problem, PairKind::k_vertex_face, pairs.vertex_face);
    look(problem, PairKind::k_edge_edge, pairs.edge_edge);
    if (tight_.empty()) return;
    changing_.assign(problem.movable_end, 0);
    for (int sweep = 0; sweep < k_sweeps; ++sweep)
      for (const TightPair& pair : tight_) relax(problem, pair);
    for (std::size_t i = 0; i < problem.movable_end && !bounds.radius.empty(); ++i)
      if (changing_[i]) common[i] *= share_inside_ball(x[i] - bounds.centre[i], common[i], bounds.radius[i]);
    changed_.swap(changing_);
  }
  std::fill_n(common.begin(), problem.movable_end, Vec3::Zero());
}

}  // namespace ft
