// See droplet_crossing.h. With q = p - a, e = b - a, g = c - a, all linear in the share s, the point is before the
// plane by f(s) = det(q, e, g) over the triangle's doubled area; f is a cubic. Between its extremes it has one root at
// most, which is halved down to.
#include "solvers/water/droplet_crossing.h"

#include <algorithm>
#include <cmath>

namespace ft::inline solvers {
namespace {

/// A point may pass beside a triangle by so much of its size and meets it still: none slips through between two [1].
constexpr double k_edge = 1e-9;
constexpr int k_halvings = 60;

double det(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a.dot(b.cross(c));
}

struct Cubic {
  double c0, c1, c2, c3;
  double at(double s) const { return c0 + s * (c1 + s * (c2 + s * c3)); }
};

/// Where it goes from at or above zero to below within an interval in which it is monotone.
std::optional<double> fall_in(const Cubic& f, double begin, double end) {
  if (!(f.at(begin) >= 0) || !(f.at(end) < 0)) return {};
  double above = begin, below = end;
  for (int n = 0; n < k_halvings; ++n) {
    const double middle = 0.5 * (above + below);
    if (!(middle > above && middle < below)) break;
    (f.at(middle) >= 0 ? above : below) = middle;
  }
  return above;
}

std::optional<DropletCrossing> inside_at(const MovingTriangle& t, const Vec3& from, const Vec3& to, double s) {
  const Vec3 a = t.from[0] + s * (t.to[0] - t.from[0]), b = t.from[1] + s * (t.to[1] - t.from[1]),
             c = t.from[2] + s * (t.to[2] - t.from[2]), p = from + s * (to - from);
  const Vec3 normal = (b - a).cross(c - a);
  const double square = normal.squaredNorm();
  if (!(square > 0)) return {};
  DropletCrossing out;
  out.share = s;
  out.weight = {(b - p).cross(c - p).dot(normal) / square, (c - p).cross(a - p).dot(normal) / square, 0};
  out.weight[2] = 1 - out.weight[0] - out.weight[1];
  if (!(std::min({out.weight[0], out.weight[1], out.weight[2]}) >= -k_edge)) return {};
  out.normal = normal / std::sqrt(square);
  return out;
}

}  // namespace

std::optional<DropletCrossing> crossing_inwards(const MovingTriangle& t, const Vec3& from, const Vec3& to,
                                                double skin) {
  const Vec3 q = from - t.from[0], e = t.from[1] - t.from[0], g = t.from[2] - t.from[0];
  const Vec3 dq = to - t.to[0] - q, de = t.to[1] - t.to[0] - e, dg = t.to[2] - t.to[0] - g;
  const Cubic f{det(q, e, g), det(dq, e, g) + det(q, de, g) + det(q, e, dg),
                det(dq, de, g) + det(dq, e, dg) + det(q, de, dg), det(dq, de, dg)};
  // The Bernstein ordinates bound it from below.
  const double least = std::min({f.c0, f.c0 + f.c1 / 3, f.c0 + (2 * f.c1 + f.c2) / 3, f.at(1)});
  if (least >= 0) return {};
  if (f.c0 < 0 && f.c0 > -2 * skin * e.cross(g).norm() && f.c1 < 0)
    if (const auto found = inside_at(t, from, to, 0)) return found;
  // Where it turns.
  std::array<double, 4> ends{0, 0, 0, 1};
  std::size_t count = 1;
  const double a = 3 * f.c3, b = f.c2, square = b * b - a * f.c1;
  if (square > 0) {
    const double big = -b - std::copysign(std::sqrt(square), b);
    std::array<double, 2> turns{big / a, f.c1 / big};
    if (turns[1] < turns[0]) std::swap(turns[0], turns[1]);
    for (const double turn : turns)
      if (turn > 0 && turn < 1) ends[count++] = turn;
  }
  ends[count] = 1;
  for (std::size_t n = 0; n < count; ++n)
    if (const auto s = fall_in(f, ends[n], ends[n + 1]))
      if (const auto found = inside_at(t, from, to, *s)) return found;
  return {};
}

}  // namespace ft::inline solvers
