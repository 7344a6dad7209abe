#include "collision/step_bound/pair_obstacles.h"

#include <algorithm>
#include <optional>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "collision/step_bound/pair_room.h"

namespace ft::inline collision {
namespace {

constexpr std::size_t k_block = 1024;  // pairs per block

/// The vertex of each feature that advances farthest, and by how much they approach.
void take_foremost(PairKind kind, const PairMove& move, const std::array<double, 4>& advance, PairObstacle& obstacle) {
  const auto split = first_feature_size(kind);
  const auto first = std::max_element(advance.begin(), advance.begin() + split) - advance.begin();
  const auto second = std::max_element(advance.begin() + split, advance.end()) - advance.begin();
  obstacle.weight = {0, 0, 0, 0};
  obstacle.weight[at(first)] = 1;
  obstacle.weight[at(second)] = -1;
  obstacle.approach = obstacle.normal.dot(move.dx[at(second)] - move.dx[at(first)]);
}

std::optional<PairObstacle> obstacle_of(PairKind kind, const Stencil& stencil, const PairMove& move, double floor) {
  const double reach = floor + largest_relative_motion(kind, move.dx) / k_truncate_reach;
  if (box_gap_squared(kind, move.x) > reach * reach) return {};
  const auto too_far = [&](const PairRoom& room, const std::array<double, 4>& advance) {
    return pair_approach(kind, advance).sum() > may_use(room, floor);
  };
  const PairRoom room = pair_room(kind, move.x);
  if (!(room.gap > 0)) return {};
  const std::array<double, 4> advance = pair_advance(kind, room, move.dx);
  if (!too_far(room, advance)) return {};
  const PairRoom flat = flat_room(kind, move.x);
  if (flat.gap > floor && !too_far(flat, pair_advance(kind, flat, move.dx))) return {};
  if (slides_past(kind, move, std::max(floor, (1 - k_truncate_reach) * room.gap))) return {};
  PairObstacle out{stencil.v, pair_geometry(kind, move.x).weight, room.normal, 0,
                   std::max(may_use(room, floor), floor)};
  for (std::size_t k = 0; k < 4; ++k) out.approach -= out.weight[k] * room.normal.dot(move.dx[k]);
  if (out.approach <= out.allowed) take_foremost(kind, move, advance, out);
  if (out.approach <= out.allowed) return {};
  return out;
}

}  // namespace

std::vector<PairObstacle> find_obstacles(std::span<const Vec3> x, std::span<const Vec3> dx, int movable_count,
                                         const PairView& pairs, double floor) {
  const std::size_t movable_end = at(movable_count);
  CHECK(x.size() >= movable_end && dx.size() >= movable_end);
  std::vector<PairObstacle> out;
  const auto look = [&](PairKind kind) {
    std::vector<std::vector<PairObstacle>> found(block_count(pairs.count(kind), k_block));
    parallel_for(pairs.count(kind), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const Stencil stencil = pairs.stencil(kind, k);
        const PairMove move = pair_move(stencil, x, dx, dx, movable_end);
        if (const auto obstacle = obstacle_of(kind, stencil, move, floor)) found[begin / k_block].push_back(*obstacle);
      }
    });
    for (const auto& of_block : found) out.insert(out.end(), of_block.begin(), of_block.end());
  };
  look(PairKind::k_vertex_face);
  look(PairKind::k_edge_edge);
  return out;
}

}  // namespace ft::inline collision
