// See crossing_predicates.h and orientation() of crossings.h. An expansion is a sum of doubles that do not overlap,
// smallest first; adding a double or multiplying by one keeps it exact, so its sign is that of its last non-zero term.
#include "collision/check/crossing_predicates.h"

#include <cmath>

#include "collision/check/crossings.h"

namespace ft::inline collision {
namespace {

constexpr double k_half_ulp = 0x1p-53;
constexpr double k_bound_3d = (7.0 + 56.0 * k_half_ulp) * k_half_ulp;  ///< Shewchuk 1997, o3derrboundA
constexpr double k_bound_2d = (3.0 + 16.0 * k_half_ulp) * k_half_ulp;  ///< ccwerrboundA

int sign(double v) {
  return v > 0 ? 1 : v < 0 ? -1 : 0;
}

template <int capacity>
struct Expansion {
  std::array<double, capacity> term;
  int count = 0;

  /// Grow-expansion (Shewchuk, theorem 10), zeros left out.
  void add(double b) {
    double q = b;
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const double a = term[static_cast<std::size_t>(i)], sum = q + a, virtual_a = sum - q;
      const double tail = (q - (sum - virtual_a)) + (a - virtual_a);
      if (tail != 0) term[static_cast<std::size_t>(kept++)] = tail;
      q = sum;
    }
    if (q != 0) term[static_cast<std::size_t>(kept++)] = q;
    count = kept;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  template <int other>
  void add_product(const Expansion<other>& e, double b) {
    for (int i = 0; i < e.count; ++i) add_product(e.term[static_cast<std::size_t>(i)], b);
  }
  template <int m, int n>
  void add_product(const Expansion<m>& e, const Expansion<n>& f, double factor) {
    for (int i = 0; i < f.count; ++i) add_product(e, factor * f.term[static_cast<std::size_t>(i)]);
  }
  int sign_of() const { return count == 0 ? 0 : sign(term[static_cast<std::size_t>(count - 1)]); }
};

Expansion<2> difference(double a, double b) {
  Expansion<2> out;
  out.add(a);
  out.add(-b);
  return out;
}

}  // namespace

int orientation_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<Expansion<2>, 3> u, v, w;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    u[i] = difference(a[k], d[k]), v[i] = difference(b[k], d[k]), w[i] = difference(c[k], d[k]);
  }
  Expansion<192> determinant;
  for (std::size_t k = 0; k < 3; ++k) {
    Expansion<16> minor;
    minor.add_product(v[(k + 1) % 3], w[(k + 2) % 3], 1);
    minor.add_product(v[(k + 2) % 3], w[(k + 1) % 3], -1);
    determinant.add_product(minor, u[k], 1);
  }
  return determinant.sign_of();
}

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = a - d, v = b - d, w = c - d;
  const double vxwy = v.x() * w.y(), wxvy = w.x() * v.y(), wxuy = w.x() * u.y(), uxwy = u.x() * w.y(),
               uxvy = u.x() * v.y(), vxuy = v.x() * u.y();
  const double determinant = u.z() * (vxwy - wxvy) + v.z() * (wxuy - uxwy) + w.z() * (uxvy - vxuy);
  const double permanent = (std::abs(vxwy) + std::abs(wxvy)) * std::abs(u.z()) +
                           (std::abs(wxuy) + std::abs(uxwy)) * std::abs(v.z()) +
                           (std::abs(uxvy) + std::abs(vxuy)) * std::abs(w.z());
  // Below the smallest safe product the bound itself may have underflowed.
  const double bound = k_bound_3d * permanent;
  if (permanent > 1e-200 && (determinant > bound || -determinant > bound)) return sign(determinant);
  return orientation_exact(a, b, c, d);
}

int orientation_2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y()), right = (a.y() - c.y()) * (b.x() - c.x());
  const double determinant = left - right, magnitude = std::abs(left) + std::abs(right);
  if (magnitude > 1e-200 && std::abs(determinant) > k_bound_2d * magnitude) return sign(determinant);
  Expansion<24> exact;
  const Expansion<2> ax = difference(a.x(), c.x()), by = difference(b.y(), c.y()), ay = difference(a.y(), c.y()),
                     bx = difference(b.x(), c.x());
  exact.add_product(ax, by, 1);
  exact.add_product(ay, bx, -1);
  return exact.sign_of();
}

}  // namespace ft::inline collision
