#include "solvers/linear/level.h"

#include <algorithm>
#include <array>
#include <map>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "baker/core/random.h"

namespace ft {
namespace {

constexpr std::size_t k_rows = 256;  ///< rows per block of work

/// Of the symmetric part of a block, shifted by 1e-7 of its trace; zero where it has none.
PaddedBlock inverse_of(const Mat3f& block) {
  const double trace = block.trace(), shift = 1e-7 * trace;
  PaddedBlock inverse;
  if (!(trace > 0)) return inverse;
  const double xx = block(0, 0) + shift, yy = block(1, 1) + shift, zz = block(2, 2) + shift;
  const double xy = 0.5 * (static_cast<double>(block(0, 1)) + block(1, 0));
  const double xz = 0.5 * (static_cast<double>(block(0, 2)) + block(2, 0));
  const double yz = 0.5 * (static_cast<double>(block(1, 2)) + block(2, 1));
  const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;  // cofactors
  const double cyy = xx * zz - xz * xz, cyz = xy * xz - xx * yz, czz = xx * yy - xy * xy;
  const double scale = 1 / (xx * cxx + xy * cxy + xz * cxz);
  const auto entry = [scale](double cofactor) { return static_cast<float>(scale * cofactor); };
  inverse.columns[0] << entry(cxx), entry(cxy), entry(cxz), 0;
  inverse.columns[1] << entry(cxy), entry(cyy), entry(cyz), 0;
  inverse.columns[2] << entry(cxz), entry(cyz), entry(czz), 0;
  return inverse.columns[0].allFinite() && inverse.columns[1].allFinite() && inverse.columns[2].allFinite()
             ? inverse
             : PaddedBlock();
}

}  // namespace

void Level::build() {
  const std::size_t n = at(size());
  matrix.reset(*pattern);
  inverse.resize(n);
  for (auto* v : {&x, &r, &b}) v->assign(n, Vec4f::Zero());
  if (pattern != &own_pattern) return;
  probe.assign(n, Vec4f::Zero());
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c)
      probe[i][c] = static_cast<float>(2 * random_uniform({.element = i}, static_cast<std::uint64_t>(c)) - 1);
}

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

  // Contributions per coarse block (I, J) with J >= I: of a fine block, and of the one that mirrors it.
  struct Contributions {
    std::vector<Level::Contribution> straight, transposed;
  };
  std::vector<std::map<int, Contributions>> upper(nc);
  for (std::size_t i = 0; i < p.rows.size(); ++i)
    for (int k = fine.pattern->row_start[i]; k < fine.pattern->row_start[i + 1]; ++k) {
      const std::size_t j = at(fine.pattern->column[at(k)]);
      const Interpolation::Row &row = p.rows[i], &col = p.rows[j];
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) {
          if (row.coarse[a] < 0 || col.coarse[b] < row.coarse[a]) continue;
          Contributions& to = upper[at(row.coarse[a])][col.coarse[b]];
          (j < i ? to.transposed : to.straight).push_back({fine.pattern->place[at(k)], row.weight[a] * col.weight[b]});
        }
    }
  std::vector<std::vector<std::array<int, 4>>> stencils(1);
  for (std::size_t i = 0; i < nc; ++i)
    for (const auto& entry : upper[i]) stencils[0].push_back({static_cast<int>(i), entry.first, -1, -1});
  coarse.own_pattern = make_pattern(static_cast<int>(nc), stencils);
  coarse.pattern = &coarse.own_pattern;
  coarse.build();
  std::size_t count = 0;
  for (const auto& row : upper)
    for (const auto& [j, both] : row) count += both.straight.size() + both.transposed.size();
  fine.gather.reserve(count);
  fine.gather_start.assign(1, 0);
  for (std::size_t i = 0; i < nc; ++i)
    for (auto& [j, both] : upper[i])
      for (auto* list : {&both.straight, &both.transposed}) {
        std::sort(list->begin(), list->end(), [](const auto& x, const auto& y) { return x.place < y.place; });
        fine.gather.insert(fine.gather.end(), list->begin(), list->end());
        fine.gather_start.push_back(static_cast<int>(fine.gather.size()));
      }
  CHECK(fine.gather_start.size() == 2 * coarse.pattern->block_count() + 1);
  return true;
}

void galerkin(const Level& fine, Level& coarse) {
  const auto sum_of = [&fine](std::size_t list) {
    using Eight = Eigen::Array<float, 8, 1>;
    Eight first = Eight::Zero();
    float ninth = 0;
    for (int k = fine.gather_start[list]; k < fine.gather_start[list + 1]; ++k) {
      const Level::Contribution& g = fine.gather[at(k)];
      const float* block = fine.matrix.blocks[at(g.place)].data();
      first += g.weight * Eigen::Map<const Eight>(block);
      ninth += g.weight * block[8];
    }
    Mat3f sum;
    Eigen::Map<Eight>(sum.data()) = first;
    sum(2, 2) = ninth;
    return sum;
  };
  parallel_for(coarse.pattern->block_count(), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) coarse.matrix.blocks[e] = sum_of(2 * e) + sum_of(2 * e + 1).transpose();
  });
  for (const int d : coarse.pattern->diagonal) {  // symmetric, but for rounding
    Mat3f& block = coarse.matrix.blocks[at(d)];
    block = (0.5f * (block + block.transpose())).eval();
  }
}

void invert_diagonal(Level& level) {
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      level.inverse[i] = inverse_of(level.matrix.blocks[at(level.pattern->diagonal[i])]);
    }
  });
}

void estimate_damping(Level& level) {
  level.x = level.probe;
  // Largest eigenvalue of D^-1 A through its Rayleigh quotient in the D inner product, (A x).(D^-1 A x) / x.(A x).
  double eigenvalue = 0;
  for (int step = 0; step < 4; ++step) {
    const Vec2 quotient =
        parallel_sum(at(level.size()), k_rows, Vec2(0, 0), [&](std::size_t begin, std::size_t end) -> Vec2 {
          Vec2 sum(0, 0);
          for (std::size_t i = begin; i < end; ++i) {
            const Vec4f product = level.product(i, level.x);
            level.r[i] = level.inverse[i] * product;
            sum += Vec2(product.dot(level.r[i]), product.dot(level.x[i]));
          }
          return sum;
        });
    level.x.swap(level.r);
    if (quotient[1] > 0) eigenvalue = std::max(eigenvalue, quotient[0] / quotient[1]);
  }
  level.damping = static_cast<float>(1.6 / (1.25 * std::max(eigenvalue, 1.0)));
}

void smooth_first(Level& level) {
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) level.x[i] = level.damping * (level.inverse[i] * level.b[i]);
  });
}

void smooth(Level& level) {
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      level.r[i] = level.x[i] + level.damping * (level.inverse[i] * (level.b[i] - level.product(i, level.x)));
  });
  level.x.swap(level.r);
}

void residual(Level& level) {
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) level.r[i] = level.b[i] - level.product(i, level.x);
  });
}

void restrict_to(Level& coarse, const Level& fine, std::span<const Vec4f> residual) {
  parallel_for(at(coarse.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      Vec4f sum = Vec4f::Zero();
      for (int k = fine.children_start[c]; k < fine.children_start[c + 1]; ++k)
        sum += fine.children_weight[at(k)] * residual[at(fine.children[at(k)])];
      coarse.b[c] = sum;
    }
  });
}

namespace {

template <bool k_add>
void interpolate_onto(Level& fine, const Level& coarse) {
  parallel_for(at(fine.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Interpolation::Row& row = fine.interpolation.rows[i];
      Vec4f sum = Vec4f::Zero();
      if (k_add) sum = fine.x[i];
      for (std::size_t k = 0; k < 3; ++k)
        if (row.coarse[k] >= 0) sum += row.weight[k] * coarse.x[at(row.coarse[k])];
      fine.x[i] = sum;
    }
  });
}

}  // namespace

void interpolate(Level& fine, const Level& coarse) {
  interpolate_onto<false>(fine, coarse);
}

void add_interpolated(Level& fine, const Level& coarse) {
  interpolate_onto<true>(fine, coarse);
}

}  // namespace ft
