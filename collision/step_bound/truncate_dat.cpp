#include "collision/step_bound/truncate_dat.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft::inline collision {
namespace {

constexpr std::size_t k_block = 1024;  // pairs per block

/// A minimum does not depend on the order of its arguments, so this one may be taken by any thread at any time.
inline void lower(double& target, double value) {
  std::atomic_ref<double> shared(target);
  double seen = shared.load(std::memory_order_relaxed);
  while (value < seen && !shared.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
}

/// The shares that a plane with the room's normal proves; none where it does not even prove what is in common.
std::array<double, 4> shares_along(const PairRoom& room, PairKind kind, const PairMove& move, double floor) {
  const int split = first_feature_size(kind);
  const std::array<double, 4> advance = pair_advance(kind, room, move.common);
  const PairApproach approach = pair_approach(kind, advance);
  const double left = may_use(room, floor) - approach.sum();
  if (!(room.gap > 0) || left < 0) return {0, 0, 0, 0};
  std::array<double, 4> rest{};  // of the displacement, towards the other feature
  double rest_first = 0, rest_second = 0;
  bool first_moves = false, second_moves = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool first = static_cast<int>(i) < split;
    const double along = room.normal.dot(move.dx[i] - move.common[i]);
    rest[i] = std::max(0.0, first ? -along : along);
    (first ? rest_first : rest_second) = std::max(first ? rest_first : rest_second, rest[i]);
    (first ? first_moves : second_moves) |= move.movable[i];
  }
  std::array<double, 4> share{1, 1, 1, 1};
  if (rest_first + rest_second <= 0) return share;
  double part_of_first = std::clamp(rest_first / (rest_first + rest_second), 0.05, 0.95);
  if (!first_moves) part_of_first = 0;
  if (!second_moves) part_of_first = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(rest[i] > 0)) continue;
    const bool first = static_cast<int>(i) < split;
    const double own =
        (first ? approach.first : approach.second) - advance[i] + (first ? part_of_first : 1 - part_of_first) * left;
    share[i] = std::clamp(own / rest[i], 0.0, 1.0);
  }
  return share;
}

/// Whether a pair can be cut at all; most cannot, and the distance between their boxes tells.
bool may_be_cut(PairKind kind, const PairMove& move, double floor) {
  const int split = first_feature_size(kind);
  double rest_first = 0, rest_second = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    double& rest = static_cast<int>(i) < split ? rest_first : rest_second;
    rest = std::max(rest, (move.dx[i] - move.common[i]).squaredNorm());
  }
  if (rest_first + rest_second <= 0) return false;
  // Of what is left of the room a feature gets at least 0.95 of its share.
  const double moves =
      largest_relative_motion(kind, move.common) + (std::sqrt(rest_first) + std::sqrt(rest_second)) / 0.95;
  const double reach = floor + moves / k_truncate_reach;
  return box_gap_squared(kind, move.x) <= reach * reach;
}

}  // namespace

std::array<double, 4> truncate_pair(PairKind kind, const PairMove& move, double floor) {
  std::array<double, 4> share{0, 0, 0, 0};
  double least = -1;
  const auto take = [&](const PairRoom& room) {
    const std::array<double, 4> own = shares_along(room, kind, move, floor);
    const double smallest = *std::min_element(own.begin(), own.end());
    if (smallest > least) least = smallest, share = own;
  };
  const PairRoom room = pair_room(kind, move.x);
  if (room.gap > 0) {
    take(room);
    if (least < 1) {  // nearer than the floor along it, the pair may be far apart and yet slide together
      const PairRoom flat = flat_room(kind, move.x);
      if (flat.gap > floor) take(flat);
    }
    if (least < 1 && slides_past(kind, move, std::max(floor, (1 - k_truncate_reach) * room.gap))) share = {1, 1, 1, 1};
  }
  for (std::size_t i = 0; i < 4; ++i)
    if (!move.movable[i]) share[i] = 1;
  return share;
}

void truncate_displacements(std::span<const Vec3> x, std::span<const Vec3> dx, std::span<const Vec3> common,
                            int movable_count, const PairView& pairs, double floor, std::span<double> share) {
  const auto movable_end = static_cast<std::size_t>(movable_count);
  CHECK(x.size() >= movable_end && dx.size() >= movable_end && share.size() >= movable_end);
  CHECK(common.size() >= movable_end);
  std::fill(share.begin(), share.end(), 1.0);

  const auto run = [&](PairKind kind) {
    parallel_for(pairs.count(kind), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const Stencil stencil = pairs.stencil(kind, k);
        const PairMove move = pair_move(stencil, x, dx, common, movable_end);
        if (!may_be_cut(kind, move, floor)) continue;
        const std::array<double, 4> own = truncate_pair(kind, move, floor);
        for (std::size_t i = 0; i < 4; ++i) {
          if (move.movable[i] && own[i] < 1) lower(share[static_cast<std::size_t>(stencil.v[i])], own[i]);
        }
      }
    });
  };
  run(PairKind::k_vertex_face);
  run(PairKind::k_edge_edge);
}

}  // namespace ft::inline collision
