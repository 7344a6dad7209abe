#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "solvers/linear/linear_system_impl.h"

namespace ft::inline solvers {
namespace {

constexpr int k_coarsest_size = 64;  ///< a level of no more vertices has no coarser one
constexpr std::size_t k_rows = 256;  ///< per block of a loop

/// A cycle is made symmetric, too, where the residual has grown so many times over the least there was: what is
/// conjugate is lost by then. Solves of S1, S2 and the sewn dress hardly ever come that far.
constexpr double k_most_grown = 1.5;
/// Where a larger residual is enough, the tolerance is so many times as large at most, and no more than this share of
/// the right side.
constexpr double k_most_loose = 5;
constexpr double k_most_left = 0.5;

}  // namespace

LinearSystem::LinearSystem(const BlockPattern& pattern, std::span<const Vec3> rest_positions,
                           const LinearSettings& settings)
    : impl_(std::make_unique<Impl>()) {
  impl_->settings = settings;
  auto first = std::make_unique<Level>();
  first->pattern = &pattern;
  impl_->levels.push_back(std::move(first));
  if (settings.preconditioner != LinearSettings::Preconditioner::k_multigrid) return;
  std::vector<Vec3> rest(rest_positions.begin(), rest_positions.end());
  while (impl_->levels.back()->size() > k_coarsest_size) {
    auto coarse = std::make_unique<Level>();
    if (!link_levels(*impl_->levels.back(), *coarse, rest)) break;
    impl_->levels.push_back(std::move(coarse));
  }
}

LinearSystem::~LinearSystem() = default;

void LinearSystem::give_back() {
  ft::give_back(impl_->fine().matrix.blocks, impl_->fine().extra, impl_->fine().clusters, impl_->added,
                impl_->couplings);
}

bool LinearSystem::is_filled() const {
  return !impl_->fine().matrix.blocks.empty();
}

std::size_t LinearSystem::block_count() const {
  return impl_->fine().pattern->block_count();
}

BlockMatrix& LinearSystem::begin() {
  Level& level = impl_->fine();
  level.matrix.reset(*level.pattern);
  level.extra.clear();
  impl_->couplings.clear();
  return level.matrix;
}

void LinearSystem::add_pair_terms(std::span<const PairTerm> terms) {
  Impl& s = *impl_;
  BlockMatrix& matrix = s.fine().matrix;
  const BlockPattern& pattern = *matrix.pattern;
  s.added.clear();
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const PairTerm& term = terms[t];
    // What lies on the body is held by it: only what touches other cloth gains by clusters.
    const bool is_of_cloth_alone = *std::min_element(term.vertex.begin(), term.vertex.end()) >= 0;
    for (std::uint8_t a = 0; a < 4; ++a)
      for (std::uint8_t b = 0; b < 4; ++b) {
        const int row = term.vertex[a], column = term.vertex[b];
        if (row < 0 || column < row) continue;
        const int place = row == column ? pattern.diagonal[at(row)] : pattern.find(row, column);
        if (place >= 0) {
          matrix.blocks[at(place)] += (term.weight[a] * term.weight[b]) * term.stiffness;
          if (row != column && is_of_cloth_alone) s.couplings.push_back({row, column, place});
        } else {
          s.added.push_back({row, column, static_cast<int>(t), a, b});
        }
      }
  }
  s.fine().extra.add(s.added, terms, at(s.fine().size()));
}

double LinearSystem::stiffness_along(int vertex, const Vec3& direction) const {
  const BlockMatrix& matrix = impl_->fine().matrix;
  const Vec3f along = direction.cast<float>();
  return static_cast<double>(along.dot(matrix.blocks[at(matrix.pattern->diagonal[at(vertex)])] * along));
}

/// Rows and columns that are held become zero, so that nothing couples to them.
void LinearSystem::Impl::hold(std::span<const char> fixed) {
  Level& level = fine();
  held.assign(fixed.begin(), fixed.end());
  if (held.empty()) held.assign(at(level.size()), 0);
  if (std::all_of(held.begin(), held.end(), [](char h) { return h == 0; })) return;
  const BlockPattern& p = *level.pattern;
  ExtraRows& extra = level.extra;
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = at(p.diagonal[i]); k < at(p.diagonal[i + 1]); ++k)
        if (held[i] || held[at(p.column[k])]) level.matrix.blocks[k].setZero();
      if (extra.empty()) continue;
      for (int k = extra.start[i]; k < extra.start[i] + extra.used[i]; ++k)
        if (held[i] || held[at(extra.column[at(k)])]) extra.value[at(k)].setZero();
    }
  });
}

void LinearSystem::Impl::refresh_hierarchy() {
  invert_diagonal(fine());
  if (levels.size() > 1) fine().clusters.build(fine().matrix, fine().extra, held, couplings);
  for (std::size_t d = 1; d < levels.size(); ++d) {
    levels[d - 1]->plan.apply(levels[d - 1]->matrix, levels[d]->matrix);
    invert_diagonal(*levels[d]);
    if (d + 1 < levels.size()) estimate_damping(*levels[d]);
  }
  if (levels.size() > 1) coarsest.build(*levels.back());
}

/// Vectors for a solve from zero. False where a row has no positive diagonal: it is not seen by the preconditioner, and
/// its residual not by the norm.
bool LinearSystem::Impl::start(std::span<const Vec3> right_side) {
  Level& level = fine();
  bool sound = true;
  symmetric = levels.size() == 1;
  for (std::size_t i = 0; i < at(level.size()); ++i) {
    level.b[i].setZero();
    if (held[i]) continue;
    level.b[i].head<3>() = right_side[i].cast<float>();
    sound = sound && level.inverse[i].trace() > 0;
  }
  product.assign(level.b.size(), Vec4f::Zero());
  return sound;
}

/// The residual after one step of conjugate gradients along direction, alpha of it. False where the curvature is not
/// positive: nothing has changed then.
bool LinearSystem::Impl::step(double rz) {
  Level& level = fine();
  const double curvature = parallel_sum(direction.size(), k_rows, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      product[i] = level.product(i, direction);
      sum += static_cast<double>(direction[i].dot(product[i]));
    }
    return sum;
  });
  if (!(curvature > 0) || !std::isfinite(curvature)) return false;
  alpha = static_cast<float>(rz / curvature);
  parallel_for(direction.size(), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) level.b[i] -= alpha * product[i];
  });
  return true;
}

/// The solution after that step, and the next direction.
void LinearSystem::Impl::advance(float beta) {
  parallel_for(direction.size(), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      solution[i] += alpha * direction[i].head<3>();
      direction[i] = preconditioned()[i] + beta * direction[i];
    }
  });
}

LinearReport LinearSystem::solve(std::span<const Vec3> right_side, std::span<const char> fixed, std::vector<Vec3>& out,
                                 double enough) {
  Impl& s = *impl_;
  ft::give_back(out);
  for (const auto& level : s.levels) level->make_room();
  s.hold(fixed);
  s.refresh_hierarchy();
  const bool sound = s.start(right_side);
  s.solution.assign(right_side.size(), Vec3f::Zero());

  LinearReport report;
  report.converged =
      std::all_of(s.fine().b.begin(), s.fine().b.end(), [](const Vec4f& v) { return v == Vec4f::Zero(); });
  double best_residual = report.converged ? 0 : 1;
  bool is_best = true;  // the solution so far, of all there were
  const Products first = s.precondition(std::numeric_limits<double>::infinity());
  report.start_norm = std::sqrt(first.norm_squared);
  const double least = s.settings.tolerance, most = std::max(least, std::min(k_most_loose * least, k_most_left));
  const double tolerance = std::clamp(enough / report.start_norm, least, most);
  double rz = first.with_residual;
  s.direction = s.preconditioned();
  while (!report.converged && report.iterations < s.settings.max_iterations && std::isfinite(rz) && rz > 0) {
    if (!s.step(rz)) break;
    ++report.iterations;
    const double most_residual = k_most_grown * best_residual;
    const auto [next, along_last, norm_squared] = s.precondition(most_residual * most_residual * first.norm_squared);
    const double residual = std::sqrt(norm_squared / first.norm_squared);
    const bool better = residual < best_residual;
    if (is_best && !better) s.best = s.solution;
    is_best = better;
    if (is_best) best_residual = residual;
    // Flexible: the cycle is not symmetric (Bouwmeester et al. 2015, Nonsymmetric Preconditioning for Conjugate
    // Gradient and Steepest Descent Methods), so that the difference of two residuals stands for the new one alone.
    s.advance(-s.alpha * static_cast<float>(along_last / rz));
    if (!(next >= 0) || !std::isfinite(next)) break;
    report.converged = residual <= tolerance && sound;
    rz = next;
  }
  report.residual = best_residual;
  for (const auto& level : s.levels) level->give_back();
  ft::give_back(s.held, s.direction, s.product);
  if (!is_best) s.solution.swap(s.best);
  out.resize(s.solution.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = s.solution[i].cast<double>();
  ft::give_back(s.solution, s.best);
  return report;
}

}  // namespace ft::inline solvers
