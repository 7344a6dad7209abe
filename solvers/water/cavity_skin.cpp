#include "solvers/water/cavity_skin.h"

#include <cmath>
#include <numbers>

namespace ft::inline solvers {
namespace {

constexpr double k_neck_weight = 0.05;   ///< of a neck's length, which nobody sees, against a wall's
constexpr double k_no_width = 1e-4;      ///< m
constexpr double k_round = 0.3;          ///< radius of the rounded rim, of the cavity's [1]
constexpr int k_arc_points = 4;          ///< of the rounded rim
constexpr double k_surround = 3;         ///< half-width of the squares, of the rim's radius [1]
constexpr double k_share_of_wall = 0.6;  ///< the same, of the wall's length [1]

/// A circle of a cavity's wall.
struct Circle {
  double depth = 0, radius = 0;  ///< m
  Vec2 centre = Vec2::Zero();    ///< x, z [m]
  double along = 0;              ///< the wall from the rim to here, necks weighted [m]
};

/// From the rim down to the middle of the bottom.
std::vector<Circle> wall_of(const WaterCavity& cavity, double cell) {
  std::vector<Circle> out;
  const auto add = [&](double depth, double radius, const Vec3& centre) {
    Circle c{depth, radius, Vec2(centre.x(), centre.z())};
    if (!out.empty()) {
      const Circle& last = out.back();
      const bool neck = std::max(c.radius, last.radius) < k_no_width;
      c.along = last.along + (neck ? k_neck_weight : 1) * std::hypot(c.depth - last.depth, c.radius - last.radius);
    }
    out.push_back(c);
  };
  const auto depth_of = [&](const AirDisc& disc) { return cavity.level - disc.centre.y(); };
  const AirDisc &top = cavity.discs.front(), &bottom = cavity.discs.back();
  const double end = depth_of(bottom) + 0.5 * bottom.thickness;
  double rounded = 0;
  if (depth_of(top) < top.thickness) {
    rounded = std::min({k_round * top.radius, cell, 0.5 * end});
    for (int n = 0; n <= k_arc_points; ++n) {
      const double angle = 0.5 * std::numbers::pi * n / k_arc_points;
      add(rounded * (1 - std::cos(angle)), top.radius + rounded * (1 - std::sin(angle)), top.centre);
    }
  } else {
    add(0, 0, top.centre);
    add(depth_of(top) - 0.5 * top.thickness, 0, top.centre);
  }
  for (std::size_t k = 0; k < cavity.discs.size(); ++k) {
    const AirDisc& disc = cavity.discs[k];
    if (depth_of(disc) <= rounded) continue;
    if (k > 0) {
      const AirDisc& above = cavity.discs[k - 1];
      if (depth_of(disc) - depth_of(above) > 0.75 * (disc.thickness + above.thickness)) {
        add(depth_of(above) + 0.5 * above.thickness, 0, above.centre);
        add(depth_of(disc) - 0.5 * disc.thickness, 0, disc.centre);
      }
    }
    add(depth_of(disc), disc.radius, disc.centre);
  }
  add(end, bottom.radius, bottom.centre);
  add(end, 0, bottom.centre);
  return out;
}

Circle circle_at(std::span<const Circle> wall, double along) {
  std::size_t k = 1;
  while (k + 1 < wall.size() && wall[k].along < along) ++k;
  const Circle &a = wall[k - 1], &b = wall[k];
  const double t = b.along > a.along ? std::clamp((along - a.along) / (b.along - a.along), 0.0, 1.0) : 1;
  return {a.depth + t * (b.depth - a.depth), a.radius + t * (b.radius - a.radius), a.centre + t * (b.centre - a.centre),
          along};
}

/// Where on a circle a vertex of a square comes to lie: those of a side share a quarter equally.
Vec2 direction_of(int di, int dk) {
  constexpr double k_eighth = 0.25 * std::numbers::pi;
  if (di == 0 && dk == 0) return Vec2::Zero();
  double angle = 0;
  if (std::abs(di) >= std::abs(dk))
    angle = k_eighth * dk / di + (di < 0 ? std::numbers::pi : 0.0);
  else
    angle = 2 * k_eighth - k_eighth * di / dk + (dk < 0 ? std::numbers::pi : 0.0);
  return {std::cos(angle), std::sin(angle)};
}

/// The squares around a cavity.
struct Surroundings {
  std::vector<Circle> wall;
  int i = 0, k = 0;       ///< vertex in the middle of the squares
  double half_width = 0;  ///< beyond it vertices stay where they are [m]; 0: there is no room
  bool overlaps(const Surroundings& other, double cell) const {
    return std::max(std::abs(i - other.i), std::abs(k - other.k)) * cell < half_width + other.half_width;
  }
};

Surroundings surroundings_of(const WaterCavity& cavity, const WaterGrid& grid) {
  Surroundings out{wall_of(cavity, grid.cell)};
  const Circle &rim = out.wall.front(), &bottom = out.wall.back();
  const Vec2 middle = (rim.centre - grid.origin) / grid.cell;
  if (!(middle.x() > 0 && middle.y() > 0 && middle.x() < grid.nx && middle.y() < grid.nz)) return out;
  out.i = static_cast<int>(std::lround(middle.x())), out.k = static_cast<int>(std::lround(middle.y()));
  const int room = std::min({out.i, out.k, grid.nx - out.i, grid.nz - out.k}) - 1;
  const double wanted = std::max(k_surround * rim.radius, k_share_of_wall * bottom.along + 2 * grid.cell);
  const double half_width = std::min(wanted, room * grid.cell);
  // Vertices may be drawn in, but never pushed past one another.
  if (half_width > std::max(1.3 * rim.radius + grid.cell, 3 * (rim.radius - bottom.along))) out.half_width = half_width;
  return out;
}

double smooth(double t) {
  return t * t * (3 - 2 * t);
}

void draw_in(const WaterGrid& grid, std::span<const double> heights, double level, const Surroundings& around,
             std::vector<DrawnIn>& out) {
  const Circle &rim = around.wall.front(), &bottom = around.wall.back();
  const double width = around.half_width, annulus = width - rim.radius;
  const Vec2 node = grid.origin + grid.cell * Vec2(around.i, around.k);
  const int reach = static_cast<int>(std::ceil(width / grid.cell));
  for (int dk = -reach; dk <= reach; ++dk)
    for (int di = -reach; di <= reach; ++di) {
      const int ring = std::max(std::abs(di), std::abs(dk));
      const double inwards = width - ring * grid.cell;  // of the vertex, from the outermost square
      if (!(inwards > 0)) continue;
      // As far again along the surface and down the wall; at the outermost square nothing is drawn in.
      const double way = inwards + (bottom.along - rim.radius) * std::pow(inwards / width, 3);
      const Vec2 direction = direction_of(di, dk);
      DrawnIn& v = out.emplace_back();
      v.vertex = at(around.k + dk) * (at(grid.nx) + 1) + at(around.i + di);
      v.on_wall = way >= annulus;
      if (!v.on_wall) {
        const double radius = width - way, round = smooth(std::clamp(way / annulus, 0.0, 1.0));
        const Vec2 square = Vec2(di, dk) / ring;
        const Vec2 p = node + round * (rim.centre - node) + radius * (square + round * (direction - square));
        v.place = Vec3(p.x(), between_vertices(grid, heights, p.x(), p.y()), p.y());
        continue;
      }
      const Circle circle = circle_at(around.wall, way - annulus);
      const Vec2 p = circle.centre + circle.radius * direction, edge = rim.centre + rim.radius * direction;
      // What waves lift at the rim they lift less further down.
      const double lift = between_vertices(grid, heights, edge.x(), edge.y()) - level;
      const double share = std::max(0.0, 1 - circle.depth / std::max(bottom.depth, 2 * std::abs(lift)));
      v.place = Vec3(p.x(), level - circle.depth + share * lift, p.y());
    }
}

}  // namespace

std::vector<DrawnIn> draw_in(const WaterGrid& grid, std::span<const double> heights,
                             std::span<const WaterCavity> cavities) {
  std::vector<std::pair<double, Surroundings>> all;  // level
  for (const WaterCavity& cavity : cavities)
    if (!cavity.discs.empty()) all.emplace_back(cavity.level, surroundings_of(cavity, grid));
  std::ranges::stable_sort(
      all, [](const auto& a, const auto& b) { return a.second.wall.back().along > b.second.wall.back().along; });
  std::vector<DrawnIn> out;
  std::vector<const Surroundings*> drawn;
  for (const auto& [level, around] : all) {
    const auto overlaps = [&](const Surroundings* other) { return around.overlaps(*other, grid.cell); };
    if (!(around.half_width > 0) || std::ranges::any_of(drawn, overlaps)) continue;
    draw_in(grid, heights, level, around, out);
    drawn.push_back(&around);
  }
  return out;
}

}  // namespace ft::inline solvers
