// Random pairs of features for the tests of this folder: well-shaped, degenerate and nearly degenerate ones.
#pragma once

#include <array>
#include <cmath>

#include "baker/core/random.h"
#include "baker/core/types.h"
#include "collision/geometry/pair_geometry.h"

namespace ft::test {

/// A stream of numbers that depends on its name alone.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : key_{seed, 0, 0, 0} {}
  double uniform() { return random_uniform(key_, draw_++); }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
  int below(int n) { return static_cast<int>(uniform() * n); }
  Vec3 cube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3 direction() {
    while (true) {
      const Vec3 v = cube(1);
      const double n = v.norm();
      if (n > 0.01 && n < 1) return v / n;
    }
  }

 private:
  RandomKey key_;
  std::uint64_t draw_ = 0;
};

/// Four points of one of several kinds: anywhere; on a small grid (coincident, parallel, coplanar); the grid with 1e-12
/// of noise; slivers, of a width down to 1e-14 of their length.
inline std::array<Vec3, 4> random_stencil(Dice& dice, double scale) {
  std::array<Vec3, 4> x;
  const int kind = dice.below(4);
  for (Vec3& p : x) {
    p = dice.cube(1);
    if (kind == 1 || kind == 2) p = Vec3(dice.below(3), dice.below(3), dice.below(2));
    if (kind == 2) p += Vec3(dice.below(3) - 1, dice.below(3) - 1, dice.below(3) - 1) * 1e-12;
  }
  if (kind == 3) {
    const Vec3 along = dice.direction();
    const double width = std::pow(10, dice.uniform(-14, -1));
    for (std::size_t i = 1; i < 4; ++i) x[i] = x[0] * 0.1 + along * dice.uniform(-1, 1) + width * dice.direction();
    if (dice.below(2) == 0) x[0] = x[1] + along * dice.uniform(-1, 1) + width * dice.direction();
  }
  for (Vec3& p : x) p *= scale;
  return x;
}

/// True when the pair stayed apart all the way from x to x + dx. Straight moves on their own sides of one plane do;
/// planes are tried across the closest points along the way and along the features' own normal. A rest that no plane
/// decides is followed in small pieces.
inline bool stays_apart(PairKind kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& dx, int depth = 0) {
  std::array<Vec3, 4> middle, end;
  for (std::size_t i = 0; i < 4; ++i) middle[i] = x[i] + 0.5 * dx[i], end[i] = x[i] + dx[i];
  for (const auto& where : {x, end, middle}) {
    const PairGeometry g = pair_geometry(kind, where);
    if (separates(kind, x, g, 1e-9) && separates(kind, end, g, 1e-9)) return true;
  }
  Vec3 flat = kind == PairKind::k_vertex_face ? (x[2] - x[1]).cross(x[3] - x[1]) : (x[1] - x[0]).cross(x[3] - x[2]);
  if (flat.norm() > 1e-30) {
    PairGeometry g = pair_geometry(kind, x);
    for (const double sign : {1.0, -1.0}) {
      g.normal = sign * flat.normalized();
      if (separates(kind, x, g, 1e-9) && separates(kind, end, g, 1e-9)) return true;
    }
  }
  if (depth == 12) return false;
  std::array<Vec3, 4> half;
  for (std::size_t i = 0; i < 4; ++i) half[i] = 0.5 * dx[i];
  return stays_apart(kind, x, half, depth + 1) && stays_apart(kind, middle, half, depth + 1);
}

}  // namespace ft::test
