#include "solvers/linear/level.h"

#include <algorithm>
#include <array>
#include <map>

#include "baker/core/parallel.h"
#include "baker/core/random.h"

namespace ft {
namespace {

constexpr std::size_t k_rows = 512;  ///< rows per block of work

Vec4f row_product(const Level& level, std::size_t row, const Vec4f* x) {
  Vec4f sum = Vec4f::Zero();
  const int end = level.pattern->row_start[row + 1];
  for (int k = level.pattern->row_start[row]; k < end; ++k) {
    const float* block = level.blocks.data() + 9 * at(k);
    const Vec4f& v = x[at(level.pattern->column[at(k)])];
    sum += Eigen::Map<const Vec4f>(block) * v[0] + Eigen::Map<const Vec4f>(block + 3) * v[1] +
           Eigen::Map<const Vec4f>(block + 6) * v[2];
  }
  sum[3] = 0;  // the loads overlap the next column
  return sum;
}

}  // namespace

bool link_levels(Level& fine, Level& coarse) {
  fine.interpolation = make_interpolation(*fine.pattern, fine.rest);
  const Interpolation& p = fine.interpolation;
  if (p.coarse_count() > (3 * fine.size()) / 4) return false;
  const std::size_t nc = at(p.coarse_count());
  for (std::size_t c = 0; c < nc; ++c) coarse.rest.push_back(fine.rest[at(p.coarse_to_fine[c])]);

  std::vector<std::vector<std::pair<int, float>>> children(nc);
  for (std::size_t v = 0; v < p.rows.size(); ++v)
    for (std::size_t k = 0; k < 3; ++k)
      if (p.rows[v].coarse[k] >= 0)
        children[at(p.rows[v].coarse[k])].push_back({static_cast<int>(v), p.rows[v].weight[k]});
  fine.children_start.assign(1, 0);
  for (const auto& list : children) {
    for (const auto& [v, w] : list) fine.children.push_back(v), fine.children_weight.push_back(w);
    fine.children_start.push_back(static_cast<int>(fine.children.size()));
  }

  // Contributions per coarse block (I, J) with J >= I.
  std::vector<std::map<int, std::vector<Level::Contribution>>> upper(nc);
  for (std::size_t i = 0; i < p.rows.size(); ++i)
    for (int k = fine.pattern->row_start[i]; k < fine.pattern->row_start[i + 1]; ++k) {
      const Interpolation::Row& row = p.rows[i];
      const Interpolation::Row& col = p.rows[at(fine.pattern->column[at(k)])];
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) {
          if (row.coarse[a] < 0 || col.coarse[b] < row.coarse[a]) continue;
          upper[at(row.coarse[a])][col.coarse[b]].push_back({k, row.weight[a] * col.weight[b]});
        }
    }
  std::vector<std::vector<std::array<int, 4>>> stencils(1);
  for (std::size_t i = 0; i < nc; ++i)
    for (const auto& [j, list] : upper[i]) stencils[0].push_back({static_cast<int>(i), j, -1, -1});
  coarse.own_pattern = make_pattern(static_cast<int>(nc), stencils);
  coarse.pattern = &coarse.own_pattern;
  fine.gather_start.assign(1, 0);
  for (std::size_t i = 0; i < nc; ++i)
    for (auto& [j, list] : upper[i]) {
      std::sort(list.begin(), list.end(), [](const auto& x, const auto& y) { return x.block < y.block; });
      fine.gather.insert(fine.gather.end(), list.begin(), list.end());
      fine.gather_start.push_back(static_cast<int>(fine.gather.size()));
      fine.upper.push_back(coarse.pattern->find(static_cast<int>(i), j));
      fine.lower.push_back(coarse.pattern->find(j, static_cast<int>(i)));
    }
  return true;
}

void galerkin(const Level& fine, Level& coarse) {
  parallel_for(fine.upper.size(), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      Vec4f c0 = Vec4f::Zero(), c1 = Vec4f::Zero();
      float c2 = 0;
      for (int k = fine.gather_start[e]; k < fine.gather_start[e + 1]; ++k) {
        const Level::Contribution& g = fine.gather[at(k)];
        const float* block = fine.blocks.data() + 9 * at(g.block);
        c0 += g.weight * Eigen::Map<const Vec4f>(block);
        c1 += g.weight * Eigen::Map<const Vec4f>(block + 4);
        c2 += g.weight * block[8];
      }
      Mat3f sum;
      Eigen::Map<Vec4f>(sum.data()) = c0;
      Eigen::Map<Vec4f>(sum.data() + 4) = c1;
      sum.data()[8] = c2;
      if (fine.upper[e] == fine.lower[e]) sum = (0.5f * (sum + sum.transpose())).eval();
      Eigen::Map<Mat3f>(coarse.blocks.data() + 9 * at(fine.upper[e])) = sum;
      Eigen::Map<Mat3f>(coarse.blocks.data() + 9 * at(fine.lower[e])) = sum.transpose();
    }
  });
}

void invert_diagonal(Level& level) {
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Map<const Mat3f> block(level.blocks.data() + 9 * at(level.pattern->diagonal[i]));
      const float scale = block.trace();
      level.inverse[i].setZero();
      if (!(scale > 0)) continue;
      const Eigen::Matrix3d shifted = block.cast<double>() + Eigen::Matrix3d::Identity() * (1e-7 * scale);
      const Eigen::Matrix3d inverse = shifted.inverse();
      if (inverse.allFinite()) level.inverse[i] = (0.5 * (inverse + inverse.transpose())).cast<float>();
    }
  });
}

void estimate_damping(Level& level) {
  const std::size_t n = at(level.size());
  for (std::size_t i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c)
      level.x[i][c] = static_cast<float>(2 * random_uniform({.element = i}, static_cast<std::uint64_t>(c)) - 1);
    level.x[i][3] = 0;
  }
  // Largest eigenvalue of D^-1 A through its Rayleigh quotient in the D inner product, (A x).(D^-1 A x) / x.(A x).
  double eigenvalue = 0;
  for (int step = 0; step < 4; ++step) {
    multiply(level, level.x, level.r);
    double top = 0, bottom = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3f next = level.inverse[i] * level.r[i].head<3>();
      top += static_cast<double>(level.r[i].head<3>().dot(next));
      bottom += static_cast<double>(level.r[i].head<3>().dot(level.x[i].head<3>()));
      level.x[i].head<3>() = next;
    }
    if (bottom > 0) eigenvalue = std::max(eigenvalue, top / bottom);
  }
  level.damping = static_cast<float>(1.6 / (1.25 * std::max(eigenvalue, 1.0)));
}

void multiply(const Level& level, std::span<const Vec4f> x, std::span<Vec4f> y) {
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y[i] = row_product(level, i, x.data());
  });
}

void residual(const Level& level, std::span<const Vec4f> x, std::span<const Vec4f> b, std::span<Vec4f> r) {
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) r[i] = b[i] - row_product(level, i, x.data());
  });
}

void restrict_residual(const Level& fine, Level& coarse) {
  parallel_for(at(coarse.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      Vec4f sum = Vec4f::Zero();
      for (int k = fine.children_start[c]; k < fine.children_start[c + 1]; ++k)
        sum += fine.children_weight[at(k)] * fine.r[at(fine.children[at(k)])];
      coarse.b[c] = sum;
    }
  });
}

void prolong(Level& fine, const Level& coarse) {
  parallel_for(at(fine.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Interpolation::Row& row = fine.interpolation.rows[i];
      for (std::size_t k = 0; k < 3; ++k)
        if (row.coarse[k] >= 0) fine.x[i] += row.weight[k] * coarse.x[at(row.coarse[k])];
    }
  });
}

}  // namespace ft
