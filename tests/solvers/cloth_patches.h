// Small cloth meshes for the tests of the energies: grids, jittered grids, a patch with a curved rest shape of two
// fabrics.
#pragma once

#include <functional>
#include <vector>

#include "baker/core/random.h"
#include "solvers/energies/cloth_topology.h"

namespace ft {

/// Triangles of a grid of columns x rows cells; vertex (i, j) is i + (columns + 1) j. Diagonals alternate.
inline std::vector<Triangle> grid_triangles(int columns, int rows) {
  std::vector<Triangle> out;
  const auto v = [&](int i, int j) { return i + (columns + 1) * j; };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      if ((i + j) % 2 == 0) {
        out.push_back({v(i, j), v(i + 1, j), v(i + 1, j + 1)});
        out.push_back({v(i, j), v(i + 1, j + 1), v(i, j + 1)});
      } else {
        out.push_back({v(i, j), v(i + 1, j), v(i, j + 1)});
        out.push_back({v(i + 1, j), v(i + 1, j + 1), v(i, j + 1)});
      }
  return out;
}

/// Grid points, place(s, t) with s and t in [0, 1].
inline std::vector<Vec3> grid_points(int columns, int rows, const std::function<Vec3(double, double)>& place) {
  std::vector<Vec3> out;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      out.push_back(place(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
  return out;
}

inline std::vector<Vec3> jitter(std::vector<Vec3> x, double amplitude, std::uint64_t seed) {
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int k = 0; k < 3; ++k)
      x[i][k] += amplitude * (2 * random_uniform({seed, 0, 0, i}, static_cast<std::uint64_t>(k)) - 1);
  return x;
}

/// 10 cm x 12 cm of an irregular mesh, rolled to a radius of 8 cm, as two pieces of different, orthotropic, damped
/// fabric that are sewn and buttoned to each other at one border.
inline ClothTopology curved_patch(int columns, int rows) {
  const auto place = [](double s, double t) {
    const double angle = 1.25 * s;
    return Vec3(0.08 * std::sin(angle), 0.12 * t, 0.08 * std::cos(angle));
  };
  auto rest = grid_points(columns, rows, place);
  auto triangles = grid_triangles(columns, rows);
  const int count = static_cast<int>(rest.size());
  const auto more = grid_points(columns, rows, [&](double s, double t) { return Vec3(place(s, t) + Vec3(0, 0, 0.1)); });
  rest.insert(rest.end(), more.begin(), more.end());
  const std::size_t first = triangles.size();
  for (std::size_t t = 0; t < first; ++t)
    triangles.push_back({triangles[t][0] + count, triangles[t][1] + count, triangles[t][2] + count});
  rest = jitter(std::move(rest), 0.02 / columns, 77);
  Fabric jersey, denim;
  jersey.stretch_warp = 120, jersey.stretch_weft = 60, jersey.shear = 30, jersey.poisson = 0.4, jersey.damping = 5e-3;
  denim.stretch_warp = 1500, denim.stretch_weft = 900, denim.shear = 200, denim.poisson = 0.2, denim.bend_warp = 2e-4;
  denim.bend_weft = 5e-5;
  denim.limit_warp = 0.01, denim.limit_weft = 0.03, denim.limit_shear = 0.01;
  const ClothPiece pieces[] = {{0, count, jersey}, {count, count, denim}};
  ClothTopology out = make_cloth_topology(rest, triangles, pieces);
  // Sewn border to border, wide open, below the force limit: as stiff as the membrane.
  for (int i = 0; i + 1 < columns; ++i) {
    SeamPoint seam;
    seam.vertex = i;
    seam.edge = {count + i, count + i + 1};
    seam.place = 0.3;
    seam.stiffness = 200, seam.pull = seam.hold = 1e9;
    out.seams.push_back(seam);
  }
  // Buttoned in the next row, by cords that are shorter than the way.
  for (int i = 0; i < columns; ++i) {
    AttachPoint button;
    button.vertex = i + columns + 1;
    button.triangle = triangles[first + at(2 * columns + i)];
    button.weight = {0.2, 0.5, 0.3};
    button.length = 0.06, button.stiffness = 200, button.max_pull = 1e9;
    out.attachments.push_back(button);
  }
  return out;
}

}  // namespace ft
