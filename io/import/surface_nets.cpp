#include "io/import/surface_nets.h"

namespace ft {

NetSurface surface_nets(const FieldGrid& grid) {
  NetSurface out;
  const int cx = grid.nx - 1, cy = grid.ny - 1, cz = grid.nz - 1;
  std::vector<int> vertex(static_cast<std::size_t>(cx) * static_cast<std::size_t>(cy) * static_cast<std::size_t>(cz), -1);
  const auto cell = [&](int x, int y, int z) -> int& {
    return vertex[static_cast<std::size_t>(x) + static_cast<std::size_t>(cx) * (static_cast<std::size_t>(y) + static_cast<std::size_t>(cy) * static_cast<std::size_t>(z))];
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
  for (int z = 1; z < cz; ++z)
    for (int y = 1; y < cy; ++y)
      for (int x = 1; x < cx; ++x)
        for (int axis = 0; axis < 3; ++axis) {
          const int to[3] = {x + (axis == 0), y + (axis == 1), z + (axis == 2)};
          const bool here = grid.values[grid.index(x, y, z)] < 0, there = grid.values[grid.index(to[0], to[1], to[2])] < 0;
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

}  // namespace ft
