// The planes are found from the vertices, not from the closest points: along the pair's normal the lowest vertex of the
// first feature and the highest of the second bound the room. A wrong normal (sliver) then costs motion, never safety.
//
//      first      ----o-----.----      lowest vertex of the first feature
//                 - - - - - - - -      its plane: it may come down to here          |
//      floor                           kept free                                   | room + floor
//                 - - - - - - - -      plane of the second feature                  |
//      second     ------.----o---      highest vertex of the second feature
#include "collision/truncate_dat.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "baker/core/check.h"
#include "baker/core/parallel.h"

namespace ft {
namespace {

constexpr std::size_t k_block = 1024;  // pairs per block

/// A minimum does not depend on the order of its arguments, so this one may be taken by any thread at any time.
inline void lower(double& target, double value) {
  std::atomic_ref<double> shared(target);
  double seen = shared.load(std::memory_order_relaxed);
  while (value < seen && !shared.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
}

/// True when the plane's normal n separates the two features by more than keep, wherever between start and end each
/// vertex is.
bool separates_throughout(int split, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& end, const Vec3& n,
                          double keep) {
  double lowest_first = std::numeric_limits<double>::infinity(), highest_second = -lowest_first;
  for (std::size_t i = 0; i < 4; ++i) {
    const double a = n.dot(x[i] - x[0]), b = n.dot(end[i] - x[0]);
    if (static_cast<int>(i) < split)
      lowest_first = std::min({lowest_first, a, b});
    else
      highest_second = std::max({highest_second, a, b});
  }
  return lowest_first - highest_second > keep;
}

/// A pair that slides past itself keeps apart although it approaches along the line between its closest points: cloth
/// that glides over the inner edges of a flat face. The face's normal, the common normal of the edges, or the normal
/// where the pair ends proves it; any plane will do.
bool slides_past(PairKind kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& dx,
                 const std::array<bool, 4>& movable, double keep) {
  const int split = first_feature_size(kind);
  std::array<Vec3, 4> end = x;
  for (std::size_t i = 0; i < 4; ++i)
    if (movable[i]) end[i] += dx[i];
  Vec3 flat = kind == PairKind::k_vertex_face ? (x[2] - x[1]).cross(x[3] - x[1]) : (x[1] - x[0]).cross(x[3] - x[2]);
  const double length = flat.norm();
  if (length > 1e-30) {
    flat /= length;
    if (flat.dot(x[0] - x[3]) < 0) flat = -flat;
    if (separates_throughout(split, x, end, flat, keep)) return true;
  }
  return separates_throughout(split, x, end, pair_geometry(kind, end).normal, keep);
}

}  // namespace

std::array<double, 4> truncate_pair(PairKind kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& dx,
                                    const std::array<bool, 4>& movable, double floor) {
  std::array<double, 4> share{1, 1, 1, 1};
  const int split = first_feature_size(kind);
  const PairGeometry geometry = pair_geometry(kind, x);
  const Vec3& n = geometry.normal;

  std::array<double, 4> height{}, toward{};  // along n from x[0]; displacement towards the other feature
  for (std::size_t i = 0; i < 4; ++i) {
    height[i] = n.dot(x[i] - x[0]);
    if (movable[i]) toward[i] = static_cast<int>(i) < split ? -n.dot(dx[i]) : n.dot(dx[i]);
  }
  double lowest_first = height[0], highest_second = height[3], toward_first = 0, toward_second = 0;
  bool first_moves = false, second_moves = false;
  for (std::size_t i = 0; i < 4; ++i) {
    if (static_cast<int>(i) < split) {
      lowest_first = std::min(lowest_first, height[i]);
      toward_first = std::max(toward_first, toward[i]);
      first_moves = first_moves || movable[i];
    } else {
      highest_second = std::max(highest_second, height[i]);
      toward_second = std::max(toward_second, toward[i]);
      second_moves = second_moves || movable[i];
    }
  }

  const double gap = lowest_first - highest_second;
  if (!(gap > 0)) {  // touching, or the normal does not separate: nothing is proved, nothing moves
    for (std::size_t i = 0; i < 4; ++i) share[i] = movable[i] ? 0 : 1;
    return share;
  }
  if (toward_first <= 0 && toward_second <= 0) return share;
  const double room = std::max(0.0, gap - floor);
  const bool may_be_cut = toward_first + toward_second > k_truncate_reach * room;
  if (may_be_cut && slides_past(kind, x, dx, movable, std::max(floor, (1 - k_truncate_reach) * gap))) return share;
  double part_of_first = std::clamp(toward_first / (toward_first + toward_second), 0.05, 0.95);
  if (!first_moves) part_of_first = 0;
  if (!second_moves) part_of_first = 1;
  const double plane_first = lowest_first - part_of_first * room;
  const double plane_second = highest_second + (1 - part_of_first) * room;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(toward[i] > 0)) continue;
    const double own = static_cast<int>(i) < split ? height[i] - plane_first : plane_second - height[i];
    share[i] = std::clamp(k_truncate_reach * own / toward[i], 0.0, 1.0);
  }
  return share;
}

void truncate_displacements(std::span<const Vec3> x, std::span<const Vec3> dx, int movable_count,
                            const ContactPairs& pairs, double floor, std::span<double> share) {
  const auto movable_end = static_cast<std::size_t>(movable_count);
  CHECK(x.size() >= movable_end && dx.size() >= movable_end && share.size() >= movable_end);
  std::fill(share.begin(), share.end(), 1.0);

  const auto run = [&](PairKind kind, std::span<const Stencil> stencils) {
    const int split = first_feature_size(kind);
    parallel_for(stencils.size(), k_block, [&](std::size_t begin, std::size_t end) {
      std::array<Vec3, 4> px, pdx;
      std::array<bool, 4> movable;
      for (std::size_t k = begin; k < end; ++k) {
        const Stencil& stencil = stencils[k];
        double largest = 0;  // squared
        Vec3 lo[2], hi[2];
        for (std::size_t i = 0; i < 4; ++i) {
          const auto v = static_cast<std::size_t>(stencil.v[i]);
          px[i] = x[v];
          movable[i] = v < movable_end;
          pdx[i] = movable[i] ? dx[v] : Vec3::Zero();
          largest = std::max(largest, pdx[i].squaredNorm());
          const int side = static_cast<int>(i) < split ? 0 : 1;
          const bool opens = static_cast<int>(i) == 0 || static_cast<int>(i) == split;
          lo[side] = opens ? px[i] : Vec3(lo[side].cwiseMin(px[i]));
          hi[side] = opens ? px[i] : Vec3(hi[side].cwiseMax(px[i]));
        }
        if (!(largest > 0)) continue;
        // With gap - floor > 2 / 0.9 max|dx| every vertex may move fully: the box distance already decides most pairs.
        const double reach = floor + 2.25 * std::sqrt(largest);
        const Vec3 apart = (lo[0] - hi[1]).cwiseMax(lo[1] - hi[0]).cwiseMax(0.0);
        if (apart.squaredNorm() > reach * reach) continue;
        const std::array<double, 4> own = truncate_pair(kind, px, pdx, movable, floor);
        for (std::size_t i = 0; i < 4; ++i) {
          if (movable[i] && own[i] < 1) lower(share[static_cast<std::size_t>(stencil.v[i])], own[i]);
        }
      }
    });
  };
  run(PairKind::k_vertex_face, pairs.vertex_face);
  run(PairKind::k_edge_edge, pairs.edge_edge);
}

}  // namespace ft
