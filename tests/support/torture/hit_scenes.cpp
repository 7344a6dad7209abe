// Torture scenes in which cloth is hit at speed, falls in a pile, lies on points, or has triangles of very different
// size.
#include <numbers>

#include "baker/core/random.h"
#include "tests/support/torture/scene_functions.h"
#include "tests/support/torture/shapes.h"

namespace ft::torture {
namespace {

constexpr double k_pi = std::numbers::pi;

Pose still(double) {
  return Pose::Identity();
}

ClothSetup setup_of(std::vector<ClothGarment> garments, std::shared_ptr<const Trajectory> body) {
  ClothSetup setup;
  setup.primary = std::move(body);
  setup.preroll_frames = 0;
  setup.garments = std::move(garments);
  return setup;
}

/// A sheet that hangs from a bar; a ball goes through its middle with `speed` [m/s] and stops 1.2 m behind.
ClothSetup ball_through(double speed) {
  constexpr int k_cells = 32;
  constexpr double k_side = 0.6;
  Shape ball;
  make_sphere(0.08, 16, 24, ball.points, ball.triangles);
  RigidParts body;
  body.add("bar", moved(box({0.64, 0.02, 0.02}), {0, 0.016, 0}), still);
  body.add("ball", moved(ball, {0.013, -0.31, -0.3}), [speed](double t) {
    return shift({0, 0, std::min(speed * t, 1.5)});
  });
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = grid("sheet", k_cells, k_cells, false,
                    [](double s, double t) { return Vec3(k_side * (s - 0.5), -k_side * t, 0); });
  ClothPin top;
  for (int i = 0; i <= k_cells; ++i) top.vertices.push_back(i);
  sheet.pins.push_back(top);
  return setup_of({std::move(sheet)}, body.build());
}

ClothGarment on_a_ball(Mesh mesh) {
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = std::move(mesh);
  return sheet;
}

/// A ball that swings sideways under the cloth that lies on it.
std::shared_ptr<const Trajectory> swinging_ball(double radius) {
  Shape ball;
  make_sphere(radius, 24, 36, ball.points, ball.triangles);
  RigidParts body;
  body.add("ball", ball, [](double t) {
    return shift({0.2 * (1 - std::cos(2.5 * k_pi * t)) * (t < 1.6 ? 1 : 0), 0, 0});
  });
  return body.build();
}

/// A sheet of 32 x 32 cells in which some squares of 4 x 4 cells hold rings of squares, each `shrink` times smaller
/// than the last, and in the middle a grid of 4 x 4 cells again. Two rings.
Mesh sheet_with_dense_spots(double side, double height, double shrink, int spots) {
  constexpr int k_cells = 32, k_block = 4, k_blocks = k_cells / k_block, k_rings = 2;
  const int n = k_cells + 1;
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  const auto place = [&](double i, double j) {
    return Vec3(side * (i / k_cells - 0.5), height, side * (j / k_cells - 0.5));
  };
  const auto quad = [&](int a, int b, int c, int d) {  // around, counter-clockwise seen from above
    triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) points.push_back(place(i, j));
  const auto has_spot = [&](int bi, int bj) {  // spread evenly over the blocks
    const int k = (bj * k_blocks + bi) * 29 % (k_blocks * k_blocks);
    return k < spots;
  };
  for (int j = 0; j < k_cells; ++j)
    for (int i = 0; i < k_cells; ++i) {
      if (has_spot(i / k_block, j / k_block)) continue;
      const int a = j * n + i;
      quad(a, a + n, a + n + 1, a + 1);
    }
  // Steps around a block's rim, from its first corner.
  std::vector<std::array<int, 2>> rim;
  for (int k = 0; k < k_block; ++k) rim.push_back({0, k});
  for (int k = 0; k < k_block; ++k) rim.push_back({k, k_block});
  for (int k = 0; k < k_block; ++k) rim.push_back({k_block, k_block - k});
  for (int k = 0; k < k_block; ++k) rim.push_back({k_block - k, 0});
  for (int bj = 0; bj < k_blocks; ++bj)
    for (int bi = 0; bi < k_blocks; ++bi) {
      if (!has_spot(bi, bj)) continue;
      const double middle_i = k_block * (bi + 0.5), middle_j = k_block * (bj + 0.5);
      std::vector<int> outer;
      for (const auto& [i, j] : rim) outer.push_back((k_block * bj + j) * n + k_block * bi + i);
      double size = 1;
      std::vector<int> inside(at((k_block + 1) * (k_block + 1)), -1);
      for (int r = 0; r < k_rings; ++r) {
        size /= shrink;
        std::vector<int> inner;
        for (const auto& [i, j] : rim) {
          inner.push_back(static_cast<int>(points.size()));
          if (r + 1 == k_rings) inside[at(j * (k_block + 1) + i)] = inner.back();
          points.push_back(place(middle_i + size * (i - 0.5 * k_block), middle_j + size * (j - 0.5 * k_block)));
        }
        for (std::size_t k = 0; k < rim.size(); ++k) {
          const std::size_t next = (k + 1) % rim.size();
          quad(outer[k], outer[next], inner[next], inner[k]);
        }
        outer = inner;
      }
      for (int j = 0; j <= k_block; ++j)
        for (int i = 0; i <= k_block; ++i)
          if (int& v = inside[at(j * (k_block + 1) + i)]; v < 0) {
            v = static_cast<int>(points.size());
            points.push_back(place(middle_i + size * (i - 0.5 * k_block), middle_j + size * (j - 0.5 * k_block)));
          }
      for (int j = 0; j < k_block; ++j)
        for (int i = 0; i < k_block; ++i) {
          const auto v = [&](int di, int dj) { return inside[at((j + dj) * (k_block + 1) + i + di)]; };
          quad(v(0, 0), v(0, 1), v(1, 1), v(1, 0));
        }
    }
  return make_triangle_mesh("sheet", std::move(points), triangles);
}

/// The diagonals of some of a sheet's squares are cut in two, a small share from their first end.
Mesh with_cut_diagonals(const Mesh& sheet, double share, std::size_t every) {
  std::vector<Vec3> points = sheet.positions;
  const std::vector<Triangle> whole = triangulate(sheet);
  std::vector<Triangle> triangles;
  for (std::size_t k = 0; k + 1 < whole.size(); k += 2) {
    const auto [a, b, c] = whole[k];
    const int d = whole[k + 1][2];
    if (whole[k + 1] != Triangle{a, c, d} || k / 2 % every != 0) {
      triangles.insert(triangles.end(), {whole[k], whole[k + 1]});
      continue;
    }
    const int cut = static_cast<int>(points.size());
    points.push_back(points[at(a)] + share * (points[at(c)] - points[at(a)]));
    triangles.insert(triangles.end(), {{a, b, cut}, {cut, b, c}, {a, cut, d}, {cut, c, d}});
  }
  return make_triangle_mesh("sheet", std::move(points), triangles);
}

/// Some of a sheet's triangles get a vertex that is nearly on the middle of their longest edge.
Mesh with_caps(const Mesh& sheet, double height, std::size_t every) {
  std::vector<Vec3> points = sheet.positions;
  std::vector<Triangle> triangles;
  const std::vector<Triangle> whole = triangulate(sheet);
  for (std::size_t k = 0; k < whole.size(); ++k) {
    if (k % every != 0) {
      triangles.push_back(whole[k]);
      continue;
    }
    Triangle t = whole[k];
    const auto longest = [&] { return (points[at(t[1])] - points[at(t[0])]).norm(); };
    for (int turn = 0; turn < 2 && longest() < (points[at(t[2])] - points[at(t[1])]).norm() + 1e-6; ++turn)
      t = {t[1], t[2], t[0]};
    const Vec3 middle = 0.5 * (points[at(t[0])] + points[at(t[1])]);
    const int top = static_cast<int>(points.size());
    points.push_back(middle + height * (points[at(t[2])] - middle).normalized());
    triangles.insert(triangles.end(), {{t[0], t[1], top}, {t[1], t[2], top}, {t[2], t[0], top}});
  }
  return make_triangle_mesh("sheet", std::move(points), triangles);
}

}  // namespace

ClothSetup ball_5() {
  return ball_through(5);
}
ClothSetup ball_10() {
  return ball_through(10);
}
ClothSetup ball_20() {
  return ball_through(20);
}
ClothSetup ball_40() {
  return ball_through(40);
}

ClothSetup stack() {
  constexpr int k_sheets = 10, k_cells = 18;
  constexpr double k_side = 0.32;
  std::vector<ClothGarment> sheets;
  for (int k = 0; k < k_sheets; ++k) {
    const double angle = 0.5 * k_pi * random_uniform({5, 0, 0, static_cast<std::uint64_t>(k)});
    ClothGarment sheet;
    sheet.name = "sheet" + std::to_string(k);
    sheet.mesh = make_sheet(k_side, k_cells, 0);
    const Pose pose = shift({0.004 * k, 0.05 + 0.012 * k, -0.003 * k}) * turn(Vec3::Zero(), Vec3::UnitY(), angle);
    for (Vec3& p : sheet.mesh.positions) p = pose * p;
    sheets.push_back(std::move(sheet));
  }
  RigidParts body;
  body.add("table", moved(box({0.22, 0.02, 0.22}), {0, -0.01, 0}), still);
  return setup_of(std::move(sheets), body.build());
}

ClothSetup needles() {
  constexpr int k_across = 5;
  constexpr double k_apart = 0.07, k_height = 0.12;
  const Shape needle = lathe({{0, k_height}, {2e-3, 0.7 * k_height}, {5e-3, 0}, {0, 0}}, false, 8);
  RigidParts body;
  for (int j = 0; j < k_across; ++j)
    for (int i = 0; i < k_across; ++i)
      body.add("needle",
               moved(needle, {k_apart * (i - 2) + 0.0013 * j, 0.004 * ((3 * i + 2 * j) % 5), k_apart * (j - 2)}),
               still);
  return setup_of({on_a_ball(make_sheet(0.4, 32, 0.16))}, body.build());
}

ClothSetup dense_spots(double ratio) {
  return setup_of({on_a_ball(sheet_with_dense_spots(0.7, 0.205, std::sqrt(ratio), 10))}, swinging_ball(0.2));
}

ClothSetup tiny_triangles() {  // 32 times shorter, so 1000 times smaller
  return dense_spots(32);
}

ClothSetup cut_edges() {
  return setup_of({on_a_ball(with_cut_diagonals(make_sheet(0.7, 32, 0.205), 1.0 / 200, 10))}, swinging_ball(0.2));
}

ClothSetup caps_of(double height) {
  return setup_of({on_a_ball(with_caps(make_sheet(0.7, 32, 0.205), height, 21))}, swinging_ball(0.2));
}

ClothSetup caps() {
  return caps_of(1e-4);
}

ClothSetup tiny_edges() {
  return dense_spots(1000);
}

}  // namespace ft::torture
