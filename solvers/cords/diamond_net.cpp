#include <cmath>
#include <numbers>
#include <numeric>

#include "baker/core/check.h"
#include "solvers/cords/generators.h"

namespace ft::inline solvers {

CordGraph diamond_net(const NetMeasures& m) {
  CHECK(m.columns >= 3 && m.rows >= 1);
  CordGraph out;
  for (int r = 0; r <= m.rows; ++r) {
    const double down = static_cast<double>(r) / m.rows, radius = std::lerp(m.radius_top, m.radius_bottom, down);
    for (int c = 0; c < m.columns; ++c) {
      const double angle = 2 * std::numbers::pi * (c + 0.5 * (r % 2)) / m.columns;
      out.points.push_back(m.centre + Vec3(radius * std::cos(angle), -m.length * down, radius * std::sin(angle)));
    }
  }
  out.held.resize(at(m.columns));
  std::iota(out.held.begin(), out.held.end(), 0);
  for (int r = 0; r < m.rows; ++r)
    for (int c = 0; c < m.columns; ++c) {
      // The two knots below are half a column to either side.
      const int left = r % 2 ? c : (c + m.columns - 1) % m.columns, right = (left + 1) % m.columns;
      const int knot = r * m.columns + c, below = (r + 1) * m.columns;
      add_side(out, knot, below + left, m.pieces);
      add_side(out, knot, below + right, m.pieces);
    }
  join_strands(out);
  return out;
}

}  // namespace ft::inline solvers
