#include "collision/step_bound/pair_room.h"

#include <algorithm>
#include <limits>

namespace ft::inline collision {
namespace {

PairRoom room_along(const Vec3& normal, PairKind kind, const std::array<Vec3, 4>& x) {
  const int split = first_feature_size(kind);
  PairRoom room;
  room.normal = normal;
  double lowest_first = std::numeric_limits<double>::infinity(), highest_second = -lowest_first;
  for (std::size_t i = 0; i < 4; ++i) {
    room.behind[i] = normal.dot(x[i] - x[0]);
    if (static_cast<int>(i) < split)
      lowest_first = std::min(lowest_first, room.behind[i]);
    else
      highest_second = std::max(highest_second, room.behind[i]);
  }
  for (std::size_t i = 0; i < 4; ++i)
    room.behind[i] = static_cast<int>(i) < split ? room.behind[i] - lowest_first : highest_second - room.behind[i];
  room.gap = lowest_first - highest_second;
  return room;
}

}  // namespace

PairRoom pair_room(PairKind kind, const std::array<Vec3, 4>& x) {
  return room_along(pair_geometry(kind, x).normal, kind, x);
}

PairRoom flat_room(PairKind kind, const std::array<Vec3, 4>& x) {
  Vec3 flat = flat_normal(kind, x);
  const double length = flat.norm();
  if (!(length > 1e-30)) return {Vec3::Zero(), {}, 0};
  flat /= flat.dot(x[0] - x[3]) < 0 ? -length : length;
  return room_along(flat, kind, x);
}

std::array<double, 4> pair_advance(PairKind kind, const PairRoom& room, const std::array<Vec3, 4>& displacement) {
  const int split = first_feature_size(kind);
  std::array<double, 4> advance;
  for (std::size_t i = 0; i < 4; ++i) {
    const double along = room.normal.dot(displacement[i]);
    advance[i] = (static_cast<int>(i) < split ? -along : along) - k_truncate_reach * room.behind[i];
  }
  return advance;
}

PairApproach pair_approach(PairKind kind, const std::array<double, 4>& advance) {
  if (kind == PairKind::k_vertex_face) return {advance[0], std::max({advance[1], advance[2], advance[3]})};
  return {std::max(advance[0], advance[1]), std::max(advance[2], advance[3])};
}

std::array<double, 4> pair_retreat(PairKind kind, const std::array<double, 4>& advance, const PairApproach& approach,
                                   double part_of_first, double too_much) {
  const int split = first_feature_size(kind);
  const double first = approach.first - part_of_first * too_much,
               second = approach.second - (1 - part_of_first) * too_much;
  std::array<double, 4> along;
  for (std::size_t i = 0; i < 4; ++i)
    along[i] = static_cast<int>(i) < split ? std::max(0.0, advance[i] - first) : -std::max(0.0, advance[i] - second);
  return along;
}

bool slides_past(PairKind kind, const PairMove& move, double keep) {
  const auto split = static_cast<std::size_t>(first_feature_size(kind));
  std::array<Vec3, 4> end = move.x;
  for (std::size_t i = 0; i < 4; ++i) end[i] += move.dx[i];
  const Vec3 n = pair_geometry(kind, end).normal;
  double lowest_first = std::numeric_limits<double>::infinity(), highest_second = -lowest_first;
  for (std::size_t i = 0; i < 4; ++i) {
    const double height = n.dot(move.x[i] - move.x[0]), moved = n.dot(move.dx[i]), shared = n.dot(move.common[i]);
    if (i < split)
      lowest_first = std::min(lowest_first, height + std::min({0.0, moved, shared}));
    else
      highest_second = std::max(highest_second, height + std::max({0.0, moved, shared}));
  }
  return lowest_first - highest_second > keep;
}

}  // namespace ft::inline collision
