#include "solvers/linear/stiff_clusters.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "baker/core/disjoint_sets.h"
#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_couplings = 1024;  ///< couplings, or rows of them
/// Of the off-diagonal block, by the geometric mean of the two diagonal ones (Frobenius) [1]: 1 where nothing but one
/// contact holds both, and a third between neighbours in a sheet without any, more at its border. With 0.5 the sewn
/// dress needs a quarter more iterations.
constexpr float k_least_strength = 0.3f;
/// Added to the diagonal, of its trace, as to single blocks.
constexpr double k_shift = 1e-7;

}  // namespace

void StiffClusters::clear() {
  clusters_ = {{0}, {}};
  inverse_start_.clear();
  inverse_.clear();
  clustered_.clear();
}

/// The strongest first, as long as a cluster does not become too large.
void StiffClusters::join(std::vector<Tie>& ties, std::size_t vertices) {
  std::sort(ties.begin(), ties.end(), [](const Tie& a, const Tie& b) {
    if (a.strength != b.strength) return a.strength > b.strength;
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  });
  std::vector<int> tied;
  for (const Tie& t : ties) tied.push_back(t.row), tied.push_back(t.column);
  std::sort(tied.begin(), tied.end());
  tied.erase(std::unique(tied.begin(), tied.end()), tied.end());
  const auto number = [&](int v) {
    return static_cast<int>(std::lower_bound(tied.begin(), tied.end(), v) - tied.begin());
  };
  DisjointSets sets(tied.size());
  std::vector<int> size(tied.size(), 1);  // per root
  for (const Tie& t : ties) {
    const int a = sets.root(number(t.row)), b = sets.root(number(t.column)), together = size[at(a)] + size[at(b)];
    if (a != b && together <= k_most_vertices) size[at(sets.join(a, b))] = together;
  }
  clusters_ = sets.groups();
  clustered_.assign(vertices, 0);
  for (int& v : clusters_.items) {
    v = tied[at(v)];
    clustered_[at(v)] = 1;
  }
}

void StiffClusters::invert(int cluster, const BlockMatrix& matrix, const ExtraRows& extra) {
  const BlockPattern& pattern = *matrix.pattern;
  const std::span<const int> v = members(cluster);
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(v.size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * k_most_vertices, 3 * k_most_vertices> block(n, n);
  for (std::size_t a = 0; a < v.size(); ++a)
    for (std::size_t b = a; b < v.size(); ++b) {
      const Eigen::Index i = 3 * static_cast<Eigen::Index>(a), j = 3 * static_cast<Eigen::Index>(b);
      Mat3 value = Mat3::Zero();
      if (const int place = a == b ? pattern.diagonal[at(v[a])] : pattern.find(v[a], v[b]); place >= 0)
        value = matrix.blocks[at(place)].cast<double>();
      if (a != b && !extra.empty()) {
        const auto first = extra.column.begin() + extra.start[at(v[a])], last = first + extra.used[at(v[a])];
        if (const auto k = std::lower_bound(first, last, v[b]); k != last && *k == v[b])
          value += extra.value[at(static_cast<int>(k - extra.column.begin()))].cast<double>();
      }
      if (a == b) value = (0.5 * (value + value.transpose())).eval() + k_shift * value.trace() * Mat3::Identity();
      block.block<3, 3>(i, j) = value;
      block.block<3, 3>(j, i) = value.transpose();
    }
  const auto factor = block.llt();
  decltype(block) inverse = factor.solve(decltype(block)::Identity(n, n));
  if (factor.info() != Eigen::Success || !inverse.allFinite()) {
    // Not definite as it should be: the vertices one by one.
    inverse.setZero();
    for (Eigen::Index i = 0; i < n; i += 3) inverse.block<3, 3>(i, i) = block.block<3, 3>(i, i).inverse();
    if (!inverse.allFinite()) inverse.setZero();
  }
  Eigen::Map<Eigen::MatrixXf>(&inverse_[inverse_start_[at(cluster)]], n, n) = inverse.cast<float>();
}

std::vector<StiffClusters::Tie> StiffClusters::find_ties(const BlockMatrix& matrix, const ExtraRows& extra,
                                                         std::span<const char> held,
                                                         std::span<const Coupling> couplings) {
  const std::size_t rows = extra.empty() ? 0 : extra.used.size();
  const std::size_t first_of_extra = block_count(couplings.size(), k_couplings);
  std::vector<std::vector<Tie>> blocks(first_of_extra + block_count(rows, k_couplings));
  const auto diagonal = [&](int v) { return matrix.blocks[at(matrix.pattern->diagonal[at(v)])].norm(); };
  const auto add = [&](std::vector<Tie>& ties, int row, int column, const Mat3f& block) {
    if (held[at(row)] != 0 || held[at(column)] != 0) return;
    const float strength = block.norm() / std::sqrt(diagonal(row) * diagonal(column));
    if (strength >= k_least_strength) ties.push_back({strength, row, column});
  };
  parallel_for(couplings.size(), k_couplings, [&](std::size_t begin, std::size_t end) {
    for (const Coupling& c : couplings.subspan(begin, end - begin))
      add(blocks[begin / k_couplings], c.row, c.column, matrix.blocks[at(c.place)]);
  });
  parallel_for(rows, k_couplings, [&](std::size_t begin, std::size_t end) {
    std::vector<Tie>& ties = blocks[first_of_extra + begin / k_couplings];
    for (std::size_t i = begin; i < end; ++i)
      for (int k = extra.start[i]; k < extra.start[i] + extra.used[i]; ++k)
        if (extra.column[at(k)] > static_cast<int>(i))
          add(ties, static_cast<int>(i), extra.column[at(k)], extra.value[at(k)]);
  });
  std::vector<Tie> all;
  for (const std::vector<Tie>& ties : blocks) all.insert(all.end(), ties.begin(), ties.end());
  return all;
}

void StiffClusters::build(const BlockMatrix& matrix, const ExtraRows& extra, std::span<const char> held,
                          std::span<const Coupling> couplings) {
  clear();
  std::vector<Tie> ties = find_ties(matrix, extra, held, couplings);
  if (ties.empty()) return;
  join(ties, at(matrix.pattern->vertex_count()));
  std::size_t room = 0;
  for (int c = 0; c < count(); ++c) {
    inverse_start_.push_back(room);
    room += 9 * members(c).size() * members(c).size();
  }
  inverse_.resize(room);
  parallel_for(at(count()), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) invert(static_cast<int>(c), matrix, extra);
  });
}

void StiffClusters::solve(int cluster, std::span<const Vec4f> r, std::span<Vec4f> out) const {
  const std::size_t count = members(cluster).size();
  const float* column = &inverse_[inverse_start_[at(cluster)]];
  std::array<float, 3 * k_most_vertices> sum{};
  for (std::size_t b = 0; b < count; ++b)
    for (int k = 0; k < 3; ++k, column += 3 * count)
      for (std::size_t i = 0; i < 3 * count; ++i) sum[i] += column[i] * r[b][k];
  for (std::size_t a = 0; a < count; ++a) out[a] = Vec4f(sum[3 * a], sum[3 * a + 1], sum[3 * a + 2], 0);
}

}  // namespace ft::inline solvers
