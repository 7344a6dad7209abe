// See exact_crossings.h.
#include "tests/support/exact_crossings.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>

#include "baker/core/mesh.h"

namespace ft {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using RationalVec = std::array<Rational, 3>;

RationalVec exact(const Vec3& v) {
  return {Rational(v.x()), Rational(v.y()), Rational(v.z())};
}
RationalVec operator-(const RationalVec& a, const RationalVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Rational dot(const RationalVec& a, const RationalVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
RationalVec cross(const RationalVec& a, const RationalVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
bool zero(const RationalVec& a) {
  return a[0] == 0 && a[1] == 0 && a[2] == 0;
}
bool in_unit(const Rational& t) {
  return t >= 0 && t <= 1;
}

bool segments_meet(const RationalVec& p, const RationalVec& q, const RationalVec& r, const RationalVec& s) {
  const RationalVec along = q - p, other = s - r, between = r - p, normal = cross(along, other);
  if (!zero(normal)) {
    if (dot(between, normal) != 0) return false;
    const Rational square = dot(normal, normal);
    return in_unit(dot(cross(between, other), normal) / square) && in_unit(dot(cross(between, along), normal) / square);
  }
  const RationalVec& line = zero(along) ? other : along;
  if (zero(line)) return zero(between);
  if (!zero(cross(between, line))) return false;
  const Rational q1 = dot(along, line), r1 = dot(between, line), s1 = dot(s - p, line);
  return std::max(Rational(0), q1) >= std::min(r1, s1) && std::max(r1, s1) >= std::min(Rational(0), q1);
}

/// Where the segment is in the triangle's plane, cut by the three sides of the triangle: is anything left?
bool meets_in_rationals(const Vec3& p_in, const Vec3& q_in, const std::array<Vec3, 3>& corners) {
  const RationalVec p = exact(p_in), q = exact(q_in);
  const std::array<RationalVec, 3> c = {exact(corners[0]), exact(corners[1]), exact(corners[2])};
  const RationalVec normal = cross(c[1] - c[0], c[2] - c[0]);
  if (zero(normal))
    return segments_meet(p, q, c[0], c[1]) || segments_meet(p, q, c[1], c[2]) || segments_meet(p, q, c[2], c[0]);
  const Rational above_p = dot(normal, p - c[0]), above_q = dot(normal, q - c[0]);
  if (above_p * above_q > 0) return false;
  Rational from = 0, to = 1;
  if (above_p != above_q) from = to = above_p / (above_p - above_q);
  for (std::size_t k = 0; k < 3; ++k) {
    const RationalVec side = c[(k + 1) % 3] - c[k];
    const Rational at_p = dot(normal, cross(side, p - c[k])), at_q = dot(normal, cross(side, q - c[k]));
    if (at_p < 0 && at_q < 0) return false;
    if (at_p < 0) from = std::max(from, Rational(at_p / (at_p - at_q)));
    if (at_q < 0) to = std::min(to, Rational(at_p / (at_p - at_q)));
  }
  return from <= to;
}

/// Sign of (b - a) x (c - a) . (d - a), or 2 where 64 bits of mantissa do not decide. Each of the six products has at
/// most ten roundings; sixteen are allowed for.
int clear_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  using Real = long double;
  Real u[3], v[3], w[3], volume = 0, size = 0;
  for (int k = 0; k < 3; ++k) u[k] = Real(b[k]) - a[k], v[k] = Real(c[k]) - a[k], w[k] = Real(d[k]) - a[k];
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Real plus = u[i] * v[j] * w[k], minus = u[j] * v[i] * w[k];
    volume += plus - minus;
    size += std::fabs(plus) + std::fabs(minus);
  }
  const Real bound = 16 * std::numeric_limits<Real>::epsilon() * size;
  if (size < 1e-300L || std::fabs(volume) <= bound) return 2;
  return volume > 0 ? 1 : -1;
}

Box box_of(std::span<const Vec3> x, std::span<const int> vertices) {
  Box box;
  for (const int v : vertices) box.include(x[at(v)]);
  return box;
}

/// Triangles by the cells that their boxes meet. Those that would fill too many cells are kept apart and looked at
/// always.
class Grid {
 public:
  Grid(std::span<const Vec3> x, std::span<const Triangle> triangles) {
    double size = 0;
    for (const Triangle& t : triangles) boxes_.push_back(box_of(x, t)), size += boxes_.back().size().maxCoeff();
    cell_ = std::max(1e-6, 1.5 * size / static_cast<double>(std::max<std::size_t>(1, triangles.size())));
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const bool small = for_cells(boxes_[i], [&](std::uint64_t key) {
        entries_.push_back({key, static_cast<int>(i)});
      });
      if (!small) large_.push_back(static_cast<int>(i));
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// Triangles whose boxes meet the box, once each.
  void find(const Box& box, std::vector<int>& out) const {
    out = large_;
    const bool small = for_cells(box, [&](std::uint64_t key) {
      for (auto e = std::lower_bound(entries_.begin(), entries_.end(), std::pair(key, -1));
           e != entries_.end() && e->first == key; ++e)
        out.push_back(e->second);
    });
    if (!small)
      for (const auto& [key, triangle] : entries_) out.push_back(triangle);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    std::erase_if(out, [&](int i) { return !boxes_[at(i)].overlaps(box); });
  }

 private:
  static constexpr double k_most_cells = 512;

  template <class Visit>
  bool for_cells(const Box& box, Visit visit) const {
    std::array<std::int64_t, 3> lo, hi;
    double cells = 1;
    for (int k = 0; k < 3; ++k) {
      const double first = std::floor(box.lo[k] / cell_), last = std::floor(box.hi[k] / cell_);
      cells *= last - first + 1;
      if (!(cells <= k_most_cells) || !(std::abs(first) < 1e6) || !(std::abs(last) < 1e6))
        return false;  // 21 bits each in a key
      lo[at(k)] = static_cast<std::int64_t>(first), hi[at(k)] = static_cast<std::int64_t>(last);
    }
    for (auto i = lo[0]; i <= hi[0]; ++i)
      for (auto j = lo[1]; j <= hi[1]; ++j)
        for (auto k = lo[2]; k <= hi[2]; ++k) {
          const auto bits = [](std::int64_t c) { return static_cast<std::uint64_t>(c + (1 << 20)); };
          visit(bits(i) << 42 | bits(j) << 21 | bits(k));
        }
    return true;
  }

  double cell_ = 1;
  std::vector<Box> boxes_;
  std::vector<std::pair<std::uint64_t, int>> entries_;
  std::vector<int> large_;
};

std::vector<EdgeTriangle> find_crossings(std::span<const Vec3> edge_x, std::span<const Triangle> edge_surface,
                                         std::span<const Vec3> x, std::span<const Triangle> triangles,
                                         bool one_surface) {
  std::vector<EdgeTriangle> out;
  const Grid grid(x, triangles);
  std::vector<int> near;
  for (const Edge& e : unique_edges(edge_surface)) {
    grid.find(box_of(edge_x, e), near);
    for (const int i : near) {
      const Triangle& t = triangles[at(i)];
      const auto shares = [&](int v) { return std::find(t.begin(), t.end(), v) != t.end(); };
      if (one_surface && (shares(e[0]) || shares(e[1]))) continue;
      if (exactly_meets(edge_x[at(e[0])], edge_x[at(e[1])], x[at(t[0])], x[at(t[1])], x[at(t[2])]))
        out.push_back({e, t});
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

bool exactly_meets(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int above_p = clear_sign(a, b, c, p), above_q = clear_sign(a, b, c, q);
  if (above_p != 2 && above_p == above_q) return false;
  if (above_p != 2 && above_q != 2) {
    const int u = clear_sign(p, q, a, b), v = clear_sign(p, q, b, c), w = clear_sign(p, q, c, a);
    if (u != 2 && v != 2 && w != 2) return u == v && v == w;
  }
  return meets_in_rationals(p, q, {a, b, c});
}

std::vector<EdgeTriangle> exact_crossings(std::span<const Vec3> edge_positions, std::span<const Triangle> edge_surface,
                                          std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  return find_crossings(edge_positions, edge_surface, positions, triangles, false);
}

std::vector<EdgeTriangle> exact_own_crossings(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  return find_crossings(positions, triangles, positions, triangles, true);
}

}  // namespace ft
