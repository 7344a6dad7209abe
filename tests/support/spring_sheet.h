// Matrices for tests of the linear solver: of a sheet of springs, of noise, and as Eigen has them.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "baker/core/random.h"
#include "solvers/linear/block_matrix.h"

namespace ft::test {

/// -1 to 1.
inline double noise(std::size_t element, std::uint64_t draw) {
  return 2 * random_uniform({.element = element}, draw) - 1;
}

/// A crumpled sheet of springs: stiff along the springs, a thousand times softer across them, as cloth is.
struct SpringSheet {
  int n;
  std::vector<Vec3> rest, x;
  std::vector<std::array<int, 4>> springs;
  BlockPattern pattern;

  explicit SpringSheet(int cells) : n(cells + 1) {
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const std::size_t v = rest.size();
        const double h = 1.0 / cells;
        rest.emplace_back(h * (i + 0.2 * noise(v, 0)), h * (j + 0.2 * noise(v, 1)), 0);
        x.push_back(rest.back() + Vec3(0, 0, 0.05 * std::sin(9 * rest.back().x()) * std::cos(7 * rest.back().y())));
      }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int v = j * n + i;
        if (i + 1 < n) springs.push_back({v, v + 1, -1, -1});
        if (j + 1 < n) springs.push_back({v, v + n, -1, -1});
        if (i + 1 < n && j + 1 < n) springs.push_back({v, v + n + 1, -1, -1});
      }
    pattern = make_pattern(n * n, std::array{springs});
  }

  void fill(BlockMatrix& m) const {
    for (std::size_t i = 0; i < x.size(); ++i)
      m.blocks[at(pattern.diagonal[i])] += Mat3f::Identity() * 0.02f * float(1e4 / (n * n));
    for (const auto& s : springs) {
      const Vec3 d = (x[at(s[1])] - x[at(s[0])]).normalized();
      const Mat3f k = (1000 * d * d.transpose() + Mat3::Identity()).cast<float>();
      for (const int a : {0, 1})
        for (int b = a; b < 2; ++b) m.blocks[at(pattern.find(s[at(a)], s[at(b)]))] += a == b ? k : Mat3f(-k);
    }
  }

  std::vector<Vec3> load() const {
    std::vector<Vec3> b;
    for (std::size_t i = 0; i < x.size(); ++i) b.emplace_back(noise(i, 5), noise(i, 6) - 2, noise(i, 7));
    return b;
  }
};

inline Eigen::MatrixXd dense(const BlockMatrix& m) {
  const int n = m.pattern->vertex_count();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (int i = 0; i < n; ++i)
    m.pattern->visit_row(i, [&](int j, int place) {
      const Mat3 block = m.blocks[at(place)].cast<double>();
      a.block<3, 3>(3 * i, 3 * j) = j < i ? Mat3(block.transpose()) : block;
    });
  return a;
}

/// Any values, symmetric.
inline void fill_with_noise(BlockMatrix& m) {
  for (std::size_t p = 0; p < m.pattern->block_count(); ++p)
    for (int c = 0; c < 9; ++c) m.blocks[p].data()[c] = float(noise(p, static_cast<std::uint64_t>(c)));
  for (int i = 0; i < m.pattern->vertex_count(); ++i) {
    Mat3f& block = m.blocks[at(m.pattern->diagonal[at(i)])];
    block = (block + block.transpose()).eval();
  }
}

}  // namespace ft::test
