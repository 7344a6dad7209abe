// Random pairs of features for the tests of this folder: well-shaped, degenerate and nearly degenerate ones.
#pragma once

#include <array>
#include <cmath>

#include "baker/core/random.h"
#include "baker/core/types.h"

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

}  // namespace ft::test
