#include "solvers/linear/level.h"

#include <algorithm>
#include <cmath>

#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "baker/core/random.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_rows = 256;  ///< rows per block of work

/// Of the symmetric part of a block, shifted by 1e-7 of its trace; zero where it has none.
SymmetricBlock inverse_of(const Mat3f& block) {
  const double trace = block.trace(), shift = 1e-7 * trace;
  if (!(trace > 0)) return {};
  const double xx = block(0, 0) + shift, yy = block(1, 1) + shift, zz = block(2, 2) + shift;
  const double xy = 0.5 * (static_cast<double>(block(0, 1)) + block(1, 0));
  const double xz = 0.5 * (static_cast<double>(block(0, 2)) + block(2, 0));
  const double yz = 0.5 * (static_cast<double>(block(1, 2)) + block(2, 1));
  const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;  // cofactors
  const double cyy = xx * zz - xz * xz, cyz = xy * xz - xx * yz, czz = xx * yy - xy * xy;
  const double scale = 1 / (xx * cxx + xy * cxy + xz * cxz);
  const auto entry = [scale](double cofactor) { return static_cast<float>(scale * cofactor); };
  const SymmetricBlock inverse{{entry(cxx), entry(cxy), entry(cxz), entry(cyy), entry(cyz), entry(czz)}};
  const bool finite =
      std::all_of(inverse.entries.begin(), inverse.entries.end(), [](float f) { return std::isfinite(f); });
  return finite ? inverse : SymmetricBlock();
}

}  // namespace

void Level::make_room() {
  const std::size_t n = at(size());
  inverse.resize(n);
  for (auto* v : {&x, &b}) v->resize(n);
  if (pattern != &own_pattern) return;
  matrix.make_room(own_pattern);
  r.resize(n);
}

void Level::give_back() {
  ft::give_back(inverse, x, r, b);
  if (pattern == &own_pattern) ft::give_back(matrix.blocks);
}

bool link_levels(Level& fine, Level& coarse, std::vector<Vec3>& rest) {
  fine.interpolation = make_interpolation(*fine.pattern, rest);
  const Interpolation& p = fine.interpolation;
  if (p.coarse_count() > (3 * fine.size()) / 4) {
    fine.interpolation = {};
    return false;
  }
  for (std::size_t c = 0; c < at(p.coarse_count()); ++c) rest[c] = rest[at(p.coarse_to_fine[c])];
  rest.resize(at(p.coarse_count()));
  coarse.own_pattern = fine.plan.build(*fine.pattern, p);
  coarse.pattern = &coarse.own_pattern;
  coarse.probe.assign(at(coarse.size()), Vec4f::Zero());
  for (std::size_t i = 0; i < coarse.probe.size(); ++i)
    for (int c = 0; c < 3; ++c)
      coarse.probe[i][c] = static_cast<float>(2 * random_uniform({.element = i}, static_cast<std::uint64_t>(c)) - 1);
  return true;
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
  const StiffClusters& clusters = level.clusters;
  parallel_for(at(level.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!clusters.has(i)) level.x[i] = level.damping * (level.inverse[i] * level.b[i]);
  });
  parallel_for(at(clusters.count()), StiffClusters::k_block, [&](std::size_t begin, std::size_t end) {
    std::array<Vec4f, StiffClusters::k_most_vertices> r, z;
    for (int c = static_cast<int>(begin); c < static_cast<int>(end); ++c) {
      const std::span<const int> members = clusters.members(c);
      for (std::size_t k = 0; k < members.size(); ++k) r[k] = level.b[at(members[k])];
      clusters.solve(c, r, z);
      for (std::size_t k = 0; k < members.size(); ++k) level.x[at(members[k])] = level.damping * z[k];
    }
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
  const Interpolation& p = fine.interpolation;
  parallel_for(at(coarse.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      Vec4f sum = Vec4f::Zero();
      for (int k = p.children_start[c]; k < p.children_start[c + 1]; ++k)
        sum += static_cast<float>(p.children[at(k)].share) * residual[p.children[at(k)].vertex];
      coarse.b[c] = Interpolation::k_share * sum;
    }
  });
}

namespace {

template <bool k_add>
void interpolate_onto(Level& fine, const Level& coarse) {
  parallel_for(at(fine.size()), k_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec4f sum = Vec4f::Zero();
      for (const Interpolation::Link from : fine.interpolation.rows[i])
        if (from.share != 0) sum += static_cast<float>(from.share) * coarse.x[from.vertex];
      sum *= Interpolation::k_share;
      fine.x[i] = k_add ? Vec4f(fine.x[i] + sum) : sum;
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

}  // namespace ft::inline solvers
