#include <algorithm>

#include "baker/core/check.h"
#include "solvers/cords/generators.h"

namespace ft::inline solvers {

CordGraph rope(const RopeMeasures& m) {
  CHECK(m.pieces >= 1 && m.knots >= 0 && m.from != m.to);
  CordGraph out;
  const int pieces = m.pieces * std::max(1, m.knots);
  for (int i = 0; i <= pieces; ++i) out.points.push_back(m.from + (m.to - m.from) * (static_cast<double>(i) / pieces));
  for (int i = 0; i < pieces; ++i) out.cords.push_back({i, i + 1});
  if (m.knots > 0) {
    out.heavier.assign(out.points.size(), 0.0);
    for (int k = 1; k <= m.knots; ++k) out.heavier[at(k * m.pieces)] = m.knot_share;
  }
  if (m.hold_from) out.held.push_back(0);
  if (m.hold_to) out.held.push_back(pieces);
  join_strands(out);
  return out;
}

}  // namespace ft::inline solvers
