#include "samples/tools/panels.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace ft::sets {
namespace {

/// Quads over a rectangle: columns along u, rows from the top down.
Mesh panel(const std::string& name, int columns, int rows, const std::function<Vec3(double u, double v)>& place) {
  Mesh out;
  out.name = name;
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column)
      out.positions.push_back(place(static_cast<double>(column) / columns, static_cast<double>(row) / rows));
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int a = row * (columns + 1) + column, below = a + columns + 1;
      out.face_sizes.push_back(4);
      out.face_vertices.insert(out.face_vertices.end(), {a, below, below + 1, a + 1});
    }
  return out;
}

int cells(double length, double edge) {
  return std::max(1, static_cast<int>(std::lround(length / edge)));
}

/// Amplitude of a sine of that wavelength that is `fullness` times as long as its way.
double fold_depth(double wavelength, double fullness) {
  double low = 0, high = wavelength * fullness;
  for (int i = 0; i < 60; ++i) {
    const double depth = 0.5 * (low + high);
    double length = 0;
    constexpr int k_steps = 400;
    for (int s = 0; s < k_steps; ++s) {
      const double slope =
          depth * 2 * std::numbers::pi / wavelength * std::cos(2 * std::numbers::pi * (s + 0.5) / k_steps);
      length += std::hypot(1, slope) / k_steps;
    }
    (length < fullness ? low : high) = depth;
  }
  return low;
}

}  // namespace

Mesh make_flag(const FlagSettings& s) {
  const int columns = cells(s.length, s.edge), rows = cells(s.height, s.edge);
  Mesh out = panel("flag", columns, rows,
                   [&](double u, double v) { return Vec3(u * s.length, s.top - v * s.height, s.slack * u * u); });
  VertexGroup mast{"mast", {}, {}};
  for (int row = 0; row <= rows; ++row)
    for (const int column : {0, 1}) mast.vertices.push_back(row * (columns + 1) + column), mast.weights.push_back(1);
  out.groups.push_back(std::move(mast));
  return out;
}

Mesh make_curtain(const CurtainSettings& s) {
  const double wavelength = s.width / s.folds, depth = fold_depth(wavelength, s.fullness);
  const int per_half = cells(0.5 * wavelength * s.fullness, s.edge);  // columns between two rings
  const int columns = 2 * s.folds * per_half, rows = cells(s.height - s.bottom, s.edge);
  Mesh out = panel("curtain", columns, rows, [&](double u, double v) {
    const double swing = depth * std::cos(2 * std::numbers::pi * u * s.folds);
    return Vec3((u - 0.5) * s.width, s.height - v * (s.height - s.bottom), swing);
  });
  VertexGroup rings{"red", {}, {}};
  for (int column = 0; column <= columns; column += per_half)
    rings.vertices.push_back(column), rings.weights.push_back(1);
  out.groups.push_back(std::move(rings));
  return out;
}

}  // namespace ft::sets
