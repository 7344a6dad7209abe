#include "io/import/character/polygons.h"

namespace ft::inline io {
namespace {

double cross(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

Vec3 newell_normal(std::span<const int> corners, std::span<const Vec3> p) {
  Vec3 normal = Vec3::Zero();
  const Vec3& origin = p[static_cast<std::size_t>(corners[0])];
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    normal +=
        (p[static_cast<std::size_t>(corners[k])] - origin).cross(p[static_cast<std::size_t>(corners[k + 1])] - origin);
  return normal;
}

/// Corners in the polygon's plane, counter-clockwise.
std::vector<Vec2> flatten(std::span<const int> corners, std::span<const Vec3> positions) {
  Vec3 normal = newell_normal(corners, positions);
  const double length = normal.norm();
  normal = length > 0 ? Vec3(normal / length) : Vec3::UnitZ().eval();
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Vec2> out;
  out.reserve(corners.size());
  const Vec3& origin = positions[static_cast<std::size_t>(corners[0])];
  for (const int c : corners) {
    const Vec3 d = positions[static_cast<std::size_t>(c)] - origin;
    out.emplace_back(d.dot(u), d.dot(v));
  }
  return out;
}

bool inside(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
  return cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0;
}

void split_quad(std::span<const int> corners, std::span<const Vec3> positions, std::vector<Triangle>& out) {
  const auto p = [&](std::size_t k) -> const Vec3& { return positions[static_cast<std::size_t>(corners[k])]; };
  const Vec3 normal = newell_normal(corners, positions);
  const auto turns = [&](std::size_t a, std::size_t b, std::size_t c) {
    return (p(b) - p(a)).cross(p(c) - p(a)).dot(normal) > 0;
  };
  const bool first_inside = turns(0, 1, 2) && turns(0, 2, 3), second_inside = turns(0, 1, 3) && turns(1, 2, 3);
  const bool second_shorter = (p(3) - p(1)).squaredNorm() < (p(2) - p(0)).squaredNorm();
  const bool second = first_inside == second_inside ? second_shorter : second_inside;
  if (second) {
    out.push_back({corners[0], corners[1], corners[3]});
    out.push_back({corners[1], corners[2], corners[3]});
  } else {
    out.push_back({corners[0], corners[1], corners[2]});
    out.push_back({corners[0], corners[2], corners[3]});
  }
}

void cut_ears(std::span<const int> corners, std::span<const Vec3> positions, std::vector<Triangle>& out) {
  const std::vector<Vec2> flat = flatten(corners, positions);
  std::vector<std::size_t> left(corners.size());
  for (std::size_t k = 0; k < left.size(); ++k) left[k] = k;
  // Whether corner k of what is left can be cut off.
  const auto is_ear = [&](std::size_t k) {
    const std::size_t n = left.size();
    const Vec2 &a = flat[left[(k + n - 1) % n]], &b = flat[left[k]], &c = flat[left[(k + 1) % n]];
    if (!(cross(a, b, c) > 0)) return false;
    for (std::size_t other = 0; other < n; ++other) {
      const Vec2& p = flat[left[other]];
      if (p == a || p == b || p == c) continue;  // also where a bridge runs to a hole and back
      if (inside(p, a, b, c)) return false;
    }
    return true;
  };
  std::size_t start = 1;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    std::size_t ear = n;
    for (std::size_t step = 0; step < n && ear == n; ++step)
      if (const std::size_t k = (start + step) % n; is_ear(k)) ear = k;
    if (ear == n) break;  // it crosses itself, or has no area
    out.push_back({corners[left[(ear + n - 1) % n]], corners[left[ear]], corners[left[(ear + 1) % n]]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    start = ear + 1;  // not the same corner again: fans are long and thin
  }
  for (std::size_t k = 1; k + 1 < left.size(); ++k)
    out.push_back({corners[left[0]], corners[left[k]], corners[left[k + 1]]});
}

}  // namespace

void split_polygon(std::span<const int> corners, std::span<const Vec3> positions, std::vector<Triangle>& out) {
  if (corners.size() < 3) return;
  if (corners.size() == 3) {
    out.push_back({corners[0], corners[1], corners[2]});
  } else if (corners.size() == 4) {
    split_quad(corners, positions, out);
  } else if (corners.size() <= k_max_ear_corners) {
    cut_ears(corners, positions, out);
  } else {
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) out.push_back({corners[0], corners[k], corners[k + 1]});
  }
}

}  // namespace ft::inline io
