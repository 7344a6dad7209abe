#include "samples/tools/skirt.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ft::garments {
namespace {

constexpr int k_directions = 360;

Vec2 direction(int k) {
  const double angle = 2 * std::numbers::pi * k / k_directions;
  return Vec2(std::cos(angle), std::sin(angle));
}

/// Radius in every direction of the body between two heights, with clearance all around it.
std::vector<double> profile(const BodyShape& shape, double from, double to, double clearance) {
  std::vector<Vec2> points;
  for (const Slice& slice : shape.slices) {
    if (slice.height < from - shape.spacing || slice.height > to + shape.spacing) continue;
    for (const Vec2& p : slice.outline)
      for (int k = 0; k < 16; ++k) points.push_back(p + clearance * direction(k * k_directions / 16));
  }
  const std::vector<Vec2> hull = convex_hull(std::move(points));
  std::vector<double> radius(at(k_directions), 0.0);
  if (hull.size() >= 3)
    for (int k = 0; k < k_directions; ++k) radius[at(k)] = hull_distance(hull, shape.waist_centre, direction(k));
  return radius;
}

/// How wide the cloth may be at most in every direction and at every level, so that it passes between the body and
/// what hangs beside it, `clearance` away from that. Slopes of one half around and of one third along the height lead
/// there. Infinite where nothing hangs.
std::vector<std::vector<double>> room_within_arms(const BodyShape& shape, std::span<const double> heights,
                                                  double clearance) {
  std::vector<std::vector<double>> room(heights.size(),
                                        std::vector<double>(k_directions, std::numeric_limits<double>::infinity()));
  const double turn = 2 * std::numbers::pi / k_directions;
  for (std::size_t level = 0; level < heights.size(); ++level)
    for (const Slice& slice : shape.slices) {
      if (std::abs(slice.height - heights[level]) > clearance + shape.spacing) continue;
      for (const Vec2& place : slice.beside) {
        const Vec2 p = place - shape.waist_centre;
        const double r = p.norm(), middle = std::atan2(p.y(), p.x());
        if (!(r > clearance)) continue;
        const int reach = static_cast<int>(std::asin(clearance / r) / turn) + 1;
        for (int j = -reach; j <= reach; ++j) {
          const int k = static_cast<int>(std::lround(middle / turn)) + j;
          const double off = r * std::sin(k * turn - middle);
          if (std::abs(off) >= clearance) continue;
          double& widest = room[level][at((k % k_directions + k_directions) % k_directions)];
          widest = std::min(widest, r * std::cos(k * turn - middle) - std::sqrt(clearance * clearance - off * off));
        }
      }
    }
  for (int sweep = 0; sweep < 2; ++sweep)  // twice, for the way around
    for (std::vector<double>& around : room)
      for (int k = 0; k < k_directions; ++k) {
        double &here = around[at(k)], &next = around[at((k + 1) % k_directions)];
        next = std::min(next, here * (1 + 0.5 * turn));
      }
  for (int sweep = 0; sweep < 2; ++sweep)
    for (std::vector<double>& around : room)
      for (int k = k_directions; k-- > 0;) {
        double &here = around[at((k + 1) % k_directions)], &next = around[at(k)];
        next = std::min(next, here * (1 + 0.5 * turn));
      }
  const auto lead = [&](std::size_t from, std::size_t to) {
    for (int k = 0; k < k_directions; ++k)
      room[to][at(k)] = std::min(room[to][at(k)], room[from][at(k)] + std::abs(heights[to] - heights[from]) / 3);
  };
  for (std::size_t level = 1; level < heights.size(); ++level) lead(level - 1, level);
  for (std::size_t level = heights.size() - 1; level > 0; --level) lead(level, level - 1);
  return room;
}

/// Averages over +-8 degrees and +-24 mm of height: the slices are pixels, the cloth shall not show them. Convex places
/// lose about a millimetre.
void round_off(std::vector<std::vector<double>>& levels) {
  const int count = static_cast<int>(levels.size());
  std::vector<std::vector<double>> around = levels;
  for (int level = 0; level < count; ++level)
    for (int k = 0; k < k_directions; ++k) {
      double sum = 0;
      for (int j = -8; j <= 8; ++j) sum += levels[at(level)][at((k + j + k_directions) % k_directions)];
      around[at(level)][at(k)] = sum / 17;
    }
  for (int level = 0; level < count; ++level)
    for (int k = 0; k < k_directions; ++k) {
      double sum = 0;
      for (int j = -6; j <= 6; ++j) sum += around[at(std::clamp(level + j, 0, count - 1))][at(k)];
      levels[at(level)][at(k)] = sum / 13;
    }
}

/// Points that share the closed curve's length equally, beginning in direction 0.
std::vector<Vec2> share_equally(const std::vector<double>& radius, const Vec2& centre, int count) {
  std::vector<double> length(at(k_directions + 1), 0.0);
  const auto point = [&](int k) { return (centre + radius[at(k % k_directions)] * direction(k)).eval(); };
  for (int k = 0; k < k_directions; ++k) length[at(k + 1)] = length[at(k)] + (point(k + 1) - point(k)).norm();
  std::vector<Vec2> points;
  int k = 0;
  for (int j = 0; j < count; ++j) {
    const double wanted = length.back() * j / count;
    while (length[at(k + 1)] < wanted) ++k;
    const double s = (wanted - length[at(k)]) / (length[at(k + 1)] - length[at(k)]);
    points.push_back((1 - s) * point(k) + s * point(k + 1));
  }
  return points;
}

}  // namespace

Mesh make_skirt(const BodyShape& shape, const SkirtSettings& settings) {
  const double length =
      settings.length > 0 ? settings.length : shape.waist - shape.bounds.lo.y() - 0.30 * shape.figure_height;
  // Fine levels from waist to hem; the rings are chosen among them afterwards.
  const int level_count = std::max(2, static_cast<int>(std::ceil(length / 4e-3)));
  std::vector<std::vector<double>> levels;
  std::vector<double> meridian{0.0};                     // mean arc length down to each level
  const double allowance = settings.clearance + 3.5e-3;  // half a pixel of the slices, and what rounding off takes
  for (int level = 0; level <= level_count; ++level) {
    const double y = shape.waist - length * level / level_count;
    // 15 mm ahead of the body, so that the cloth widens before the hips do.
    levels.push_back(profile(shape, y - 15e-3, y + 8e-3, allowance));
  }
  round_off(levels);
  const std::vector<std::vector<double>> body = levels;
  for (int level = 1; level <= level_count; ++level)
    for (int k = 0; k < k_directions; ++k) {
      // Below the widest of the hips the body no longer counts: only the flare goes on.
      const double above = levels[at(level - 1)][at(k)];
      double& radius = levels[at(level)][at(k)];
      radius = std::max({radius, above, levels[0][at(k)] + settings.flare * level / level_count});
    }
  if (settings.within_arms) {
    std::vector<double> heights;
    for (int level = 0; level <= level_count; ++level) heights.push_back(shape.waist - length * level / level_count);
    const auto room = room_within_arms(shape, heights, allowance);
    for (std::size_t level = 0; level < heights.size(); ++level)
      for (std::size_t k = 0; k < at(k_directions); ++k)
        levels[level][k] = std::max(body[level][k], std::min(levels[level][k], room[level][k]));
  }
  for (int level = 1; level <= level_count; ++level) {
    double sum = 0;
    for (int k = 0; k < k_directions; ++k)
      sum += std::hypot(levels[at(level)][at(k)] - levels[at(level - 1)][at(k)], length / level_count);
    meridian.push_back(meridian.back() + sum / k_directions);
  }

  Mesh mesh;
  mesh.name = "skirt";
  for (int ring = 0; ring < settings.rings; ++ring) {
    const double wanted = meridian.back() * ring / (settings.rings - 1);
    int level = 0;
    while (level + 1 < level_count && meridian[at(level + 1)] < wanted) ++level;
    const double s =
        std::clamp((wanted - meridian[at(level)]) / (meridian[at(level + 1)] - meridian[at(level)]), 0.0, 1.0);
    std::vector<double> radius(at(k_directions));
    for (int k = 0; k < k_directions; ++k)
      radius[at(k)] = (1 - s) * levels[at(level)][at(k)] + s * levels[at(level + 1)][at(k)];
    const double y = shape.waist - length * (level + s) / level_count;
    double around = 0;
    const std::vector<Vec2> points = share_equally(radius, shape.waist_centre, settings.segments);
    for (int k = 0; k <= settings.segments; ++k) {
      const Vec2& p = points[at(k % settings.segments)];
      if (k > 0) around += (p - points[at(k - 1)]).norm();
      if (k < settings.segments) mesh.positions.emplace_back(p.x(), y, p.y());
      mesh.uvs.emplace_back(-around, meridian.back() - wanted);
    }
  }
  // The ring runs from x to z, so ring direction times downwards points outwards: corners go on, then down.
  const int n = settings.segments;
  VertexGroup waist{"waist", {}, {}};
  for (int v = 0; v < 2 * n; ++v) waist.vertices.push_back(v), waist.weights.push_back(1);
  for (int ring = 0; ring + 1 < settings.rings; ++ring)
    for (int k = 0; k < n; ++k) {
      const int next = (k + 1) % n, a = ring * n, b = a + n, ua = ring * (n + 1), ub = ua + n + 1;
      mesh.face_sizes.push_back(4);
      mesh.face_vertices.insert(mesh.face_vertices.end(), {a + k, a + next, b + next, b + k});
      mesh.face_uvs.insert(mesh.face_uvs.end(), {ua + k, ua + k + 1, ub + k + 1, ub + k});
    }
  mesh.groups.push_back(std::move(waist));
  return mesh;
}

}  // namespace ft::garments
