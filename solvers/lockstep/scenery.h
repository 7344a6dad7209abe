// The bodies that cords meet and do not move, in one step: where their vertices are at its start and where at its end.
// Between the two they go straight, all by the same share of their way.
#pragma once

#include <span>
#include <vector>

#include "baker/core/types.h"
#include "solvers/lockstep/lockstep_solver.h"

namespace ft::inline solvers {

class Scenery {
 public:
  /// bodies have to stay.
  explicit Scenery(std::span<const MetBody> bodies);

  bool empty() const { return bodies_.empty(); }
  std::size_t body_count() const { return bodies_.size(); }
  int vertex_count() const { return static_cast<int>(body_of_vertex_.size()); }
  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< of all bodies, in one numbering
  int body_of(int vertex) const { return body_of_vertex_[at(vertex)]; }
  bool moves(int body) const { return !bodies_[at(body)].fixed; }
  bool any_moves() const { return any_moves_; }

  /// Takes over a step from t0 to t1 [s].
  void begin_step(double t0, double t1);
  const Vec3& start(int vertex) const { return start_[at(vertex)]; }
  Vec3 way(int vertex) const { return end_[at(vertex)] - start_[at(vertex)]; }  ///< of the whole step

  /// One body alone, at a time: positions, and triangles in its own numbers.
  void sample(std::size_t body, double time, std::vector<Vec3>& out) const;
  std::span<const Triangle> triangles_of(std::size_t body) const {
    return bodies_[body].trajectory->surface().triangles;
  }

 private:
  void sample_all(double time, std::vector<Vec3>& out) const;

  std::span<const MetBody> bodies_;
  bool any_moves_ = false;
  std::vector<int> first_vertex_, body_of_vertex_;
  std::vector<Triangle> triangles_;
  double start_time_ = 0, end_time_ = 0;
  std::vector<Vec3> start_, end_;  ///< empty before the first step
};

}  // namespace ft::inline solvers
