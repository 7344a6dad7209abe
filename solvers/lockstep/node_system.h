// The linear system of a Newton step over nodes with three unknowns each: terms that act on weighted sums of nodes,
// added up and solved directly (sparse Cholesky, Eigen's SimplicialLDLT).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline solvers {

/// A force and its stiffness on u = sum w_k x_k: adds w_k force to a node's gradient and w_k w_l stiffness to a block.
struct NodeTerm {
  int count = 0;
  std::array<int, 6> node{};
  std::array<double, 6> weight{};
  Vec3 force = Vec3::Zero();      ///< gradient of the potential by u [N]
  Mat3 stiffness = Mat3::Zero();  ///< positive semidefinite [N/m]

  void add(int k, double w) { node[at(count)] = k, weight[at(count)] = w, ++count; }
};

class NodeSystem {
 public:
  NodeSystem();
  ~NodeSystem();
  /// diagonal: per node, times the identity [N/m].
  void begin(std::span<const double> diagonal);
  void add(const NodeTerm& term);
  /// Solves for rhs; false where the factorisation fails.
  bool solve(std::span<const Vec3> rhs, std::span<Vec3> x);

 private:
  struct Block {
    std::uint64_t key;    ///< column, row
    std::uint32_t order;  ///< of adding: sums do not depend on how blocks are sorted
    Mat3 value;
  };
  struct Solver;
  std::vector<Block> blocks_;
  int nodes_ = 0;
  std::unique_ptr<Solver> solver_;
};

}  // namespace ft::inline solvers
