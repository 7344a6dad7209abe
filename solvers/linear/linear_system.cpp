#include "solvers/linear/linear_system.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "solvers/linear/extra_rows.h"
#include "solvers/linear/level.h"

namespace ft {
namespace {

constexpr int k_dense_size = 64;      ///< vertices of the level that is factored densely
constexpr int k_dense_limit = 400;    ///< no dense factor above this size: the coarsest level is only smoothed then
constexpr std::size_t k_rows = 1024;  ///< per block of a loop

double dot(std::span<const Vec4f> a, std::span<const Vec4f> b) {
  return parallel_sum(a.size(), k_rows, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += static_cast<double>(a[i].dot(b[i]));
    return sum;
  });
}

}  // namespace

struct LinearSystem::Impl {
  LinearSettings settings;
  BlockMatrix matrix;
  std::vector<std::unique_ptr<Level>> levels;
  Eigen::LLT<Eigen::MatrixXd> coarse_factor;
  bool coarse_is_factored = false;
  std::vector<ExtraBlock> added;
  ExtraRows extra;
  std::vector<char> held;
  std::vector<Vec4f> solution, best, rhs, residual, direction, product, preconditioned;

  Level& fine() { return *levels.front(); }
  void take_matrix(std::span<const char> fixed);
  void refresh_hierarchy();
  void add_extra(std::span<const Vec4f> x, std::span<Vec4f> y, float sign) const;
  void smooth_first(Level& level);
  void smooth_again(Level& level, bool is_fine);
  void level_residual(Level& level, bool is_fine);
  void cycle(std::size_t depth);
  void solve_coarsest(Level& level);
  void precondition(std::span<const Vec4f> r, std::span<Vec4f> z);
};

LinearSystem::LinearSystem(const BlockPattern& pattern, std::span<const Vec3> rest_positions,
                           const LinearSettings& settings)
    : impl_(std::make_unique<Impl>()) {
  impl_->settings = settings;
  impl_->matrix.pattern = &pattern;
  auto first = std::make_unique<Level>();
  first->pattern = &pattern;
  first->rest.assign(rest_positions.begin(), rest_positions.end());
  impl_->levels.push_back(std::move(first));
  if (settings.preconditioner == LinearSettings::Preconditioner::k_multigrid)
    while (impl_->levels.back()->size() > k_dense_size) {
      auto coarse = std::make_unique<Level>();
      if (!link_levels(*impl_->levels.back(), *coarse)) break;
      impl_->levels.push_back(std::move(coarse));
    }
  for (auto& level : impl_->levels) {
    const std::size_t n = at(level->size());
    level->blocks.assign(9 * level->pattern->column.size() + 1, 0.f);
    level->inverse.resize(n);
    for (auto* v : {&level->x, &level->r, &level->b}) v->assign(n, Vec4f::Zero());
  }
}

LinearSystem::~LinearSystem() = default;

BlockMatrix& LinearSystem::begin() {
  impl_->matrix.reset(*impl_->matrix.pattern);
  impl_->added.clear();
  impl_->extra.gather(impl_->added, at(impl_->fine().size()));
  return impl_->matrix;
}

void LinearSystem::add_pair_terms(std::span<const PairTerm> terms) {
  Impl& s = *impl_;
  const BlockPattern& pattern = *s.matrix.pattern;
  for (const PairTerm& term : terms)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b) {
        if (term.vertex[a] < 0 || term.vertex[b] < 0) continue;
        const Mat3f value = (term.weight[a] * term.weight[b]) * term.stiffness;
        const int place = pattern.find(term.vertex[a], term.vertex[b]);
        if (place >= 0)
          s.matrix.blocks[at(place)] += value;
        else
          s.added.push_back({term.vertex[a], term.vertex[b], value});
      }
  s.extra.gather(s.added, at(s.fine().size()));
}

/// Copies the matrix into the finest level; rows and columns that are held become zero, so that nothing couples to
/// them.
void LinearSystem::Impl::take_matrix(std::span<const char> fixed) {
  Level& level = fine();
  held.assign(fixed.begin(), fixed.end());
  if (held.empty()) held.assign(at(level.size()), 0);
  const BlockPattern& p = *level.pattern;
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int k = p.row_start[i]; k < p.row_start[i + 1]; ++k) {
        Eigen::Map<Mat3f> block(level.blocks.data() + 9 * at(k));
        if (held[i] || held[at(p.column[at(k)])])
          block.setZero();
        else
          block = matrix.blocks[at(k)];
      }
    for (std::size_t i = begin; i < end; ++i)
      for (int k = extra.start[i]; k < extra.start[i] + extra.used[i]; ++k)
        if (held[i] || held[at(extra.column[at(k)])]) extra.value[at(k)].setZero();
  });
}

void LinearSystem::Impl::refresh_hierarchy() {
  invert_diagonal(fine());
  for (std::size_t d = 1; d < levels.size(); ++d) {
    galerkin(*levels[d - 1], *levels[d]);
    invert_diagonal(*levels[d]);
    if (d + 1 < levels.size()) estimate_damping(*levels[d]);
  }
  coarse_is_factored = false;
  const Level& last = *levels.back();
  if (levels.size() < 2 || last.size() > k_dense_limit) return;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * last.size(), 3 * last.size());
  for (int i = 0; i < last.size(); ++i)
    for (int k = last.pattern->row_start[at(i)]; k < last.pattern->row_start[at(i) + 1]; ++k)
      dense.block<3, 3>(3 * i, 3 * last.pattern->column[at(k)]) =
          Eigen::Map<const Mat3f>(last.blocks.data() + 9 * at(k)).cast<double>();
  const double largest = dense.diagonal().maxCoeff();
  for (int i = 0; i < dense.rows(); ++i) dense(i, i) += dense(i, i) > 0 ? 1e-6 * dense(i, i) : std::max(largest, 1.0);
  coarse_factor.compute(dense);
  coarse_is_factored = coarse_factor.info() == Eigen::Success;
}

void LinearSystem::Impl::add_extra(std::span<const Vec4f> x, std::span<Vec4f> y, float sign) const {
  if (added.empty()) return;
  parallel_for(y.size(), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3f sum = Vec3f::Zero();
      for (int k = extra.start[i]; k < extra.start[i] + extra.used[i]; ++k)
        sum += extra.value[at(k)] * x[at(extra.column[at(k)])].head<3>();
      y[i].head<3>() += sign * sum;
    }
  });
}

void LinearSystem::Impl::smooth_first(Level& level) {
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      level.x[i].head<3>() = level.damping * (level.inverse[i] * level.b[i].head<3>());
  });
}

void LinearSystem::Impl::smooth_again(Level& level, bool is_fine) {
  level_residual(level, is_fine);
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      level.x[i].head<3>() += level.damping * (level.inverse[i] * level.r[i].head<3>());
  });
}

void LinearSystem::Impl::level_residual(Level& level, bool is_fine) {
  ft::residual(level, level.x, level.b, level.r);
  if (is_fine) add_extra(level.x, level.r, -1.f);
}

void LinearSystem::Impl::solve_coarsest(Level& level) {
  if (!coarse_is_factored) {
    smooth_first(level);
    return;
  }
  Eigen::VectorXd b(3 * level.size());
  for (int i = 0; i < level.size(); ++i) b.segment<3>(3 * i) = level.b[at(i)].head<3>().cast<double>();
  coarse_factor.solveInPlace(b);
  for (int i = 0; i < level.size(); ++i) level.x[at(i)].head<3>() = b.segment<3>(3 * i).cast<float>();
}

void LinearSystem::Impl::cycle(std::size_t depth) {
  Level& level = *levels[depth];
  if (depth + 1 == levels.size()) {
    solve_coarsest(level);
    return;
  }
  smooth_first(level);
  level_residual(level, depth == 0);
  Level& coarse = *levels[depth + 1];
  restrict_residual(level, coarse);
  cycle(depth + 1);
  prolong(level, coarse);
  smooth_again(level, depth == 0);
}

void LinearSystem::Impl::precondition(std::span<const Vec4f> r, std::span<Vec4f> z) {
  Level& level = fine();
  if (levels.size() == 1) {
    parallel_for(r.size(), k_rows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) z[i].head<3>() = level.inverse[i] * r[i].head<3>(), z[i][3] = 0;
    });
    return;
  }
  std::copy(r.begin(), r.end(), level.b.begin());
  cycle(0);
  // Held rows have a zero inverse, yet interpolation writes to them.
  parallel_for(r.size(), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) z[i] = held[i] ? Vec4f::Zero().eval() : level.x[i];
  });
}

LinearReport LinearSystem::solve(std::span<const Vec3> right_side, std::span<const char> fixed, std::span<Vec3> out) {
  Impl& s = *impl_;
  const std::size_t n = at(s.fine().size());
  s.take_matrix(fixed);
  s.refresh_hierarchy();
  for (auto* v : {&s.solution, &s.best, &s.direction, &s.product, &s.preconditioned}) v->assign(n, Vec4f::Zero());
  s.rhs.assign(n, Vec4f::Zero());
  for (std::size_t i = 0; i < n; ++i)
    if (!s.held[i]) s.rhs[i].head<3>() = right_side[i].cast<float>();
  s.residual = s.rhs;

  LinearReport report;
  const double start = std::sqrt(dot(s.rhs, s.rhs));
  report.residual = start > 0 ? 1 : 0;
  report.converged = start == 0;
  double best_residual = 1;
  double rz = 0;
  if (std::isfinite(start) && start > 0) {
    s.precondition(s.residual, s.preconditioned);
    s.direction = s.preconditioned;
    rz = dot(s.residual, s.preconditioned);
  }
  const double first = rz;
  // Without a positive diagonal a row is not seen by the preconditioner, and its residual not by the norm.
  bool broken = false;
  for (std::size_t i = 0; i < n; ++i) broken = broken || (!s.held[i] && !(s.fine().inverse[i].trace() > 0));
  while (!report.converged && report.iterations < s.settings.max_iterations && std::isfinite(rz) && rz > 0) {
    multiply(s.fine(), s.direction, s.product);
    s.add_extra(s.direction, s.product, 1.f);
    const double curvature = dot(s.direction, s.product);
    if (!(curvature > 0) || !std::isfinite(curvature)) break;
    const float alpha = static_cast<float>(rz / curvature);
    parallel_for(n, k_rows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        s.solution[i] += alpha * s.direction[i];
        s.residual[i] -= alpha * s.product[i];
      }
    });
    ++report.iterations;
    s.precondition(s.residual, s.preconditioned);
    const double next = dot(s.residual, s.preconditioned);
    if (!(next >= 0) || !std::isfinite(next)) break;
    report.residual = std::sqrt(next / first);
    if (report.residual < best_residual) best_residual = report.residual, s.best = s.solution;
    report.converged = report.residual <= s.settings.tolerance && !broken;
    if (report.converged) break;
    const float beta = static_cast<float>(next / rz);
    rz = next;
    parallel_for(n, k_rows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) s.direction[i] = s.preconditioned[i] + beta * s.direction[i];
    });
  }
  if (!report.converged) report.residual = best_residual;
  for (std::size_t i = 0; i < n; ++i) out[i] = s.best[i].head<3>().cast<double>();
  return report;
}

}  // namespace ft
