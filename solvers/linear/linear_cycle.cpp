// The preconditioner of the linear system: a multigrid cycle over its levels, or Jacobi where that is as good.
#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "solvers/linear/linear_system_impl.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_rows = 256;  ///< per block of a loop
/// Where the cycle turns the residual so far that less is left along it than this share of its norm, it is made
/// symmetric.
constexpr double k_least_along = 0.1;

}  // namespace

/// A V(1,1) cycle from this level on, of the finest V(0,1) unless symmetric, but for its last smoothing step. What the
/// finest smooths before the correction is a third of its products and saves a sixth of the iterations.
void LinearSystem::Impl::correct(std::size_t depth) {
  Level& level = *levels[depth];
  Level& coarse = *levels[depth + 1];
  const bool from_zero = depth == 0 && !symmetric;
  if (from_zero) {
    restrict_to(coarse, level, level.b);
  } else {
    smooth_first(level);
    residual(level);
    restrict_to(coarse, level, level.r);
  }
  if (depth + 2 < levels.size()) {
    correct(depth + 1);
    smooth(coarse);
  } else if (coarsest.exists()) {
    coarsest.solve(coarse);
  } else {
    smooth_first(coarse);
  }
  if (from_zero)
    interpolate(level, coarse);
  else
    add_interpolated(level, coarse);
}

/// z: of M^-1 residual; what it replaces is of the product.
void LinearSystem::Impl::take(std::size_t i, const Vec4f& z, ProductLanes& lanes) {
  const Vec4f last = product[i];
  preconditioned()[i] = z;
  lanes.with_residual += (fine().b[i].array() * z.array()).cast<double>();
  lanes.with_product += (last.array() * z.array()).cast<double>();
}

/// The last smoothing step, which goes on from what the coarse levels made of the residual. rest: what they left of it;
/// by_rest: the inverse of the diagonal block, or of the cluster's, times that.
void LinearSystem::Impl::take_smoothed(std::size_t i, const Vec4f& rest, const Vec4f& by_rest, ProductLanes& lanes) {
  const Vec4f &corrected = fine().x[i], smoothed = fine().damping * by_rest;
  lanes.norm_squared += (fine().b[i].array() * corrected.array() + rest.array() * smoothed.array()).cast<double>();
  take(i, corrected + smoothed, lanes);
}

/// preconditioned() = M^-1 residual, which is the finest level's b. Held rows have a zero inverse, yet interpolation
/// writes to them.
Products LinearSystem::Impl::apply_cycle() {
  if (levels.size() == 1) return apply_jacobi();
  const Level& level = fine();
  const StiffClusters& clusters = level.clusters;
  correct(0);
  const auto left = [&](std::size_t i) -> Vec4f { return level.b[i] - level.product(i, level.x); };
  Vec3 sums = parallel_sum(at(level.size()), k_rows, Vec3(0, 0, 0), [&](std::size_t begin, std::size_t end) {
    ProductLanes own;
    for (std::size_t i = begin; i < end; ++i) {
      if (held[i]) {
        preconditioned()[i].setZero();
      } else if (!clusters.has(i)) {
        const Vec4f rest = left(i);
        take_smoothed(i, rest, level.inverse[i] * rest, own);
      }
    }
    return own.sums();
  });
  sums += parallel_sum(at(clusters.count()), clusters.k_block, Vec3(0, 0, 0), [&](std::size_t begin, std::size_t end) {
    ProductLanes own;
    std::array<Vec4f, StiffClusters::k_most_vertices> rest, by_rest;
    for (int c = static_cast<int>(begin); c < static_cast<int>(end); ++c) {
      const std::span<const int> members = clusters.members(c);
      for (std::size_t k = 0; k < members.size(); ++k) rest[k] = left(at(members[k]));
      clusters.solve(c, rest, by_rest);
      for (std::size_t k = 0; k < members.size(); ++k) take_smoothed(at(members[k]), rest[k], by_rest[k], own);
    }
    return own.sums();
  });
  return {sums[0], sums[1], symmetric ? sums[0] : sums[2]};
}

/// The same without coarse levels.
Products LinearSystem::Impl::apply_jacobi() {
  const Level& level = fine();
  const Vec3 sums = parallel_sum(at(level.size()), k_rows, Vec3(0, 0, 0), [&](std::size_t begin, std::size_t end) {
    ProductLanes own;
    for (std::size_t i = begin; i < end; ++i) {
      if (held[i])
        preconditioned()[i].setZero();
      else
        take(i, level.inverse[i] * level.b[i], own);
    }
    return own.sums();
  });
  return {sums[0], sums[1], sums[0]};
}

/// V(0,1) can turn a residual to the wrong side, or make it grow beyond most_norm_squared. For the rest of the solve
/// the cycle is symmetric then, which cannot; without a product with the last direction the next is its own alone.
Products LinearSystem::Impl::precondition(double most_norm_squared) {
  const Products first = apply_cycle();
  const bool sound = first.with_residual >= k_least_along * first.norm_squared;
  if (symmetric || (sound && first.norm_squared <= most_norm_squared)) return first;
  symmetric = true;
  fine().r.resize(fine().b.size());
  Products second = apply_cycle();
  second.with_product = 0;
  return second;
}

}  // namespace ft::inline solvers
