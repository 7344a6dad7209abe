#include "io/import/body/surface_nets.h"

#include <algorithm>

namespace ft::inline io {
namespace {

/// Corners of the set that can be reached from its lowest one along the edges of the cell.
unsigned reached(unsigned set) {
  unsigned got = set & (~set + 1), before = 0;
  while (got != before) {
    before = got;
    for (unsigned c = 0; c < 8; ++c)
      if (got >> c & 1)
        for (unsigned axis = 0; axis < 3; ++axis) got |= set & 1u << (c ^ 1u << axis);
  }
  return got;
}

bool one_sheet(unsigned inside) {
  const unsigned outside = ~inside & 255u;
  if (inside == 0 || outside == 0) return true;
  if (reached(inside) != inside || reached(outside) != outside) return false;
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned side = 0; side < 2; ++side) {
      const unsigned u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, base = side << axis;
      const bool a = inside >> base & 1, b = inside >> (base | u) & 1, c = inside >> (base | u | v) & 1,
                 d = inside >> (base | v) & 1;
      if (a == c && b == d && a != b) return false;
    }
  return true;
}

}  // namespace

void separate_sheets(FieldGrid& grid) {
  for (bool again = true; again;) {
    again = false;
    for (int z = 0; z + 1 < grid.nz; ++z)
      for (int y = 0; y + 1 < grid.ny; ++y)
        for (int x = 0; x + 1 < grid.nx; ++x) {
          unsigned inside = 0;
          std::size_t nearest = grid.values.size();
          for (int c = 0; c < 8; ++c) {
            const int at[3] = {x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)};
            const std::size_t i = grid.index(at[0], at[1], at[2]);
            const bool border = at[0] == 0 || at[1] == 0 || at[2] == 0 || at[0] == grid.nx - 1 ||
                                at[1] == grid.ny - 1 || at[2] == grid.nz - 1;
            if (grid.values[i] < 0)
              inside |= 1u << c;
            else if (!border && (nearest == grid.values.size() || grid.values[i] < grid.values[nearest]))
              nearest = i;
          }
          if (one_sheet(inside) || nearest == grid.values.size()) continue;
          grid.values[nearest] = -std::max(1e-3 * grid.spacing, 0.5 * grid.values[nearest]);
          again = true;
        }
  }
}

NetSurface surface_nets(const FieldGrid& grid) {
  NetSurface out;
  const int cx = grid.nx - 1, cy = grid.ny - 1, cz = grid.nz - 1;
  std::vector<int> vertex(static_cast<std::size_t>(cx) * static_cast<std::size_t>(cy) * static_cast<std::size_t>(cz),
                          -1);
  const auto cell = [&](int x, int y, int z) -> int& {
    return vertex[static_cast<std::size_t>(x) +
                  static_cast<std::size_t>(cx) *
                      (static_cast<std::size_t>(y) + static_cast<std::size_t>(cy) * static_cast<std::size_t>(z))];
  };
  // A vertex in every cell that the surface crosses: the mean of the crossings of its edges.
  for (int z = 0; z < cz; ++z)
    for (int y = 0; y < cy; ++y)
      for (int x = 0; x < cx; ++x) {
        double value[8];
        int inside = 0;
        for (int c = 0; c < 8; ++c) {
          value[c] = grid.values[grid.index(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))];
          inside += value[c] < 0;
        }
        if (inside == 0 || inside == 8) continue;
        Vec3 sum = Vec3::Zero();
        int count = 0;
        for (int c = 0; c < 8; ++c)
          for (int axis = 0; axis < 3; ++axis) {
            const int d = c | 1 << axis;
            if (d == c || (value[c] < 0) == (value[d] < 0)) continue;
            Vec3 p(c & 1, c >> 1 & 1, c >> 2);
            p[axis] += value[c] / (value[c] - value[d]);
            sum += p;
            ++count;
          }
        cell(x, y, z) = static_cast<int>(out.positions.size());
        out.positions.push_back(grid.point(x, y, z) + grid.spacing * sum / count);
      }
  // A quad across every grid edge that the surface crosses, between the four cells around it.
  for (int z = 0; z < cz; ++z)
    for (int y = 0; y < cy; ++y)
      for (int x = 0; x < cx; ++x)
        for (int axis = 0; axis < 3; ++axis) {
          if ((axis != 0 && x == 0) || (axis != 1 && y == 0) || (axis != 2 && z == 0)) continue;  // on the border
          const int to[3] = {x + (axis == 0), y + (axis == 1), z + (axis == 2)};
          const bool here = grid.values[grid.index(x, y, z)] < 0,
                     there = grid.values[grid.index(to[0], to[1], to[2])] < 0;
          if (here == there) continue;
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          std::array<int, 4> quad{};
          for (int k = 0; k < 4; ++k) {
            int at[3] = {x, y, z};
            at[u] -= k == 0 || k == 3;
            at[v] -= k < 2;
            quad[static_cast<std::size_t>(k)] = cell(at[0], at[1], at[2]);
          }
          if (!here) std::swap(quad[1], quad[3]);
          out.quads.push_back(quad);
        }
  return out;
}

}  // namespace ft::inline io
