#include "samples/tools/distance_grid.h"

#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "collision/check/checked_surface.h"
#include "collision/geometry/winding_number.h"

namespace ft::garments {
namespace {

/// Adds one to inside[node] where the ray along the axis says that the node is inside.
void vote(const Body& body, const DistanceGrid& grid, int axis, std::vector<unsigned char>& inside) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3, columns = grid.size[at(u)], rows = grid.size[at(v)];
  std::vector<std::vector<std::pair<double, int>>> crossings(at(columns * rows));
  for (const Triangle& t : body.triangles) {
    Vec3 p[3];
    for (int k = 0; k < 3; ++k) p[k] = (body.positions[at(t[at(k)])] - grid.origin) / grid.cell;
    const double area = (p[1][u] - p[0][u]) * (p[2][v] - p[0][v]) - (p[1][v] - p[0][v]) * (p[2][u] - p[0][u]);
    if (area == 0) continue;
    // Rays go through the nodes, a hair aside so that they do not run along the edges of symmetric bodies.
    const double aside_u = 1.7e-4, aside_v = 2.9e-4;
    const int u0 = static_cast<int>(std::floor(std::min({p[0][u], p[1][u], p[2][u]}))),
              u1 = static_cast<int>(std::ceil(std::max({p[0][u], p[1][u], p[2][u]})));
    const int v0 = static_cast<int>(std::floor(std::min({p[0][v], p[1][v], p[2][v]}))),
              v1 = static_cast<int>(std::ceil(std::max({p[0][v], p[1][v], p[2][v]})));
    for (int j = std::max(0, v0); j <= std::min(rows - 1, v1); ++j)
      for (int i = std::max(0, u0); i <= std::min(columns - 1, u1); ++i) {
        const double x = i + aside_u, y = j + aside_v;
        double w[3];
        bool hit = true;
        for (int k = 0; k < 3; ++k) {
          const Vec3 &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
          w[k] = ((b[u] - a[u]) * (y - a[v]) - (b[v] - a[v]) * (x - a[u])) / area;
          hit = hit && w[k] >= 0;
        }
        if (hit)
          crossings[at(j * columns + i)].emplace_back(w[0] * p[0][axis] + w[1] * p[1][axis] + w[2] * p[2][axis],
                                                      area > 0 ? 1 : -1);
      }
  }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      auto& line = crossings[at(j * columns + i)];
      std::sort(line.begin(), line.end());
      int winding = 0;
      std::size_t next = 0;
      for (int k = 0; k < grid.size[at(axis)]; ++k) {
        while (next < line.size() && line[next].first < k) winding += line[next++].second;
        if (winding == 0) continue;
        std::array<int, 3> node{};
        node[at(axis)] = k, node[at(u)] = i, node[at(v)] = j;
        ++inside[at(grid.index(node[0], node[1], node[2]))];
      }
    }
}

}  // namespace

double DistanceGrid::value(const Vec3& p) const {
  int base[3];
  double s[3];
  for (int k = 0; k < 3; ++k) {
    const double x = std::clamp((p[k] - origin[k]) / cell, 0.0, size[at(k)] - 1.001);
    base[k] = static_cast<int>(x);
    s[k] = x - base[k];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
    sum += (dx ? s[0] : 1 - s[0]) * (dy ? s[1] : 1 - s[1]) * (dz ? s[2] : 1 - s[2]) *
           values[at(index(base[0] + dx, base[1] + dy, base[2] + dz))];
  }
  return sum;
}

Vec3 DistanceGrid::gradient(const Vec3& p) const {
  Vec3 g;
  for (int k = 0; k < 3; ++k) {
    const Vec3 step = 0.5 * cell * Vec3::Unit(k);
    g[k] = (value(p + step) - value(p - step)) / cell;
  }
  return g;
}

DistanceGrid make_distance_grid(const Body& body, const Box& box, double cell, double band) {
  DistanceGrid grid;
  grid.origin = box.lo;
  grid.cell = cell;
  for (int k = 0; k < 3; ++k) grid.size[at(k)] = std::max(2, static_cast<int>(std::ceil(box.size()[k] / cell)) + 1);
  grid.values.assign(at(grid.size[0] * grid.size[1] * grid.size[2]), band);
  for (const Triangle& t : body.triangles) {
    Box own;
    for (const int v : t) own.include(body.positions[at(v)]);
    Box reach = own;
    reach.inflate(band);
    int lo[3], hi[3];
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::max(0, static_cast<int>(std::floor((reach.lo[k] - grid.origin[k]) / cell)));
      hi[k] = std::min(grid.size[at(k)] - 1, static_cast<int>(std::ceil((reach.hi[k] - grid.origin[k]) / cell)));
    }
    for (int z = lo[2]; z <= hi[2]; ++z)
      for (int y = lo[1]; y <= hi[1]; ++y)
        for (int x = lo[0]; x <= hi[0]; ++x) {
          double& d = grid.values[at(grid.index(x, y, z))];
          const Vec3 p = grid.node(x, y, z);
          if ((own.lo - p).cwiseMax(p - own.hi).cwiseMax(0.0).squaredNorm() >= d * d) continue;
          d = std::min(d, std::sqrt(closest_on_triangle(p, body.positions[at(t[0])], body.positions[at(t[1])],
                                                        body.positions[at(t[2])])
                                        .squared_distance));
        }
  }
  std::vector<unsigned char> inside(grid.values.size(), 0);
  for (int axis = 0; axis < 3; ++axis) vote(body, grid, axis, inside);
  CheckedSurface surface(body.triangles);
  surface.move(body.positions);
  if (surface.closed()) {
    for (std::size_t k = 0; k < inside.size(); ++k)
      if (inside[k] >= 2) grid.values[k] = -grid.values[k];
    return grid;
  }
  // Of open shells the axes only say where there is something to ask.
  const WindingTree winding(surface.tree(), body.positions, body.triangles);
  parallel_for(inside.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const int n = static_cast<int>(k), row = grid.size[0], layer = grid.size[0] * grid.size[1];
      if (inside[k] > 0 && winding.is_inside(grid.node(n % row, n % layer / row, n / layer)))
        grid.values[k] = -grid.values[k];
    }
  });
  return grid;
}

}  // namespace ft::garments
