#include "solvers/lockstep/node_system.h"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>

namespace ft::inline solvers {

struct NodeSystem::Solver {
  Eigen::SparseMatrix<double> matrix;
  std::vector<std::uint64_t> pattern, next_pattern;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> ldlt;
};

NodeSystem::NodeSystem() : solver_(std::make_unique<Solver>()) {}
NodeSystem::~NodeSystem() = default;

void NodeSystem::begin(std::span<const double> diagonal) {
  blocks_.clear();
  nodes_ = static_cast<int>(diagonal.size());
  for (std::uint32_t k = 0; k < diagonal.size(); ++k)
    blocks_.push_back({(std::uint64_t{k} << 32) | k, k, diagonal[k] * Mat3::Identity()});
}

void NodeSystem::add(const NodeTerm& term) {
  for (int a = 0; a < term.count; ++a)
    for (int b = 0; b < term.count; ++b) {
      const auto row = static_cast<std::uint64_t>(term.node[at(a)]),
                 column = static_cast<std::uint64_t>(term.node[at(b)]);
      if (row < column) continue;
      blocks_.push_back({(column << 32) | row, static_cast<std::uint32_t>(blocks_.size()),
                         term.weight[at(a)] * term.weight[at(b)] * term.stiffness});
    }
}

bool NodeSystem::solve(std::span<const Vec3> rhs, std::span<Vec3> x) {
  Solver& s = *solver_;
  std::sort(blocks_.begin(), blocks_.end(),
            [](const Block& a, const Block& b) { return a.key != b.key ? a.key < b.key : a.order < b.order; });
  std::size_t used = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    if (used > 0 && blocks_[used - 1].key == blocks_[i].key)
      blocks_[used - 1].value += blocks_[i].value;
    else
      blocks_[used++] = blocks_[i];
  blocks_.resize(used);

  s.next_pattern.clear();
  for (const Block& b : blocks_) s.next_pattern.push_back(b.key);
  const bool same = s.next_pattern == s.pattern;
  s.pattern.swap(s.next_pattern);
  // Columns of a node: its blocks lie in a row, and each gives three rows to each of three columns.
  const int size = 3 * nodes_;
  s.matrix.resize(size, size);
  s.matrix.resizeNonZeros(static_cast<Eigen::Index>(9 * blocks_.size()));
  int* outer = s.matrix.outerIndexPtr();
  int* inner = s.matrix.innerIndexPtr();
  double* value = s.matrix.valuePtr();
  int filled = 0;
  for (std::size_t begin = 0, end = 0; begin < blocks_.size(); begin = end) {
    const std::uint64_t column = blocks_[begin].key >> 32;
    while (end < blocks_.size() && blocks_[end].key >> 32 == column) ++end;
    for (int c = 0; c < 3; ++c) {
      outer[3 * column + static_cast<std::uint64_t>(c)] = filled;
      for (std::size_t b = begin; b < end; ++b)
        for (int r = 0; r < 3; ++r) {
          inner[filled] = 3 * static_cast<int>(blocks_[b].key & 0xffffffffu) + r;
          value[filled++] = blocks_[b].value(r, c);
        }
    }
  }
  outer[size] = filled;
  if (!same) s.ldlt.analyzePattern(s.matrix);
  s.ldlt.factorize(s.matrix);
  if (s.ldlt.info() != Eigen::Success) return false;
  const Eigen::Map<const Eigen::VectorXd> b(rhs[0].data(), size);
  Eigen::Map<Eigen::VectorXd>(x[0].data(), size) = s.ldlt.solve(b);
  return s.ldlt.info() == Eigen::Success;
}

}  // namespace ft::inline solvers
