// The feasible collider. Characters intersect themselves: forearm in hip, thigh in thigh. Cloth between overlapping
// parts must cross one of them, so the guarantee is stated against a collider that leaves room: of two overlapping
// parts the smaller gives way, each of its vertices inside the larger, or nearer than the gap, is moved onto the
// larger's surface plus the gap; jointed parts that fold into each other both give way (creases.h). Long triangles near
// cloth are refined first (a 230 mm capsule triangle cannot give way).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "baker/core/trajectory.h"

namespace ft::inline collision {

struct FeasibleSettings {
  double gap =
      6e-3;  ///< room kept between parts [m]; about twice the floor plus layers x thickness plus the cloth's sag
  double max_edge = 30e-3;  ///< longest edge of the refined collider [m]
  /// A vertex that would have to move farther than this to leave the larger parts, and than 0.6 of its own part's half
  /// thickness, is absent [m], 5e-3..0.1: what is carved so far is pressed flat, jumps as the larger part's nearest
  /// side changes, and drags cloth along.
  double deepest = 25e-3;
  bool carve = true;  ///< off: the drawn body, refined
};

struct CarveReport {
  int moved_vertices = 0;
  double largest_move = 0;       ///< m
  int part_a = -1, part_b = -1;  ///< the pair of parts of the largest move: a gave way to b
};

class FeasibleCollider {
 public:
  FeasibleCollider(const Surface& surface, std::span<const Vec3> bind_pose, const FeasibleSettings& settings);
  ~FeasibleCollider();

  int vertex_count() const;
  std::span<const Triangle> triangles() const;
  std::span<const int> part_of_vertex() const;
  /// True when the two parts are kept apart wherever they meet: not jointed (those are beyond their crease), and
  /// neither overlapping nor nearer than the gap in the bind pose. Parts that touch in the bind pose are kept as far
  /// apart as they are there, up to the gap, vertex by vertex. A sheet is kept apart from nothing.
  bool kept_apart(int part_a, int part_b) const;
  /// Refined positions of the drawn pose, before anything gives way.
  void refine(std::span<const Vec3> drawn, std::span<Vec3> refined) const;
  /// Refined and carved positions. Deterministic; thread-safe. absent (per vertex, or empty: not asked for): 1 where
  /// the body is so deep in itself that no cloth should meet it, else 0; see absent_vertices.h.
  CarveReport evaluate(std::span<const Vec3> drawn, std::span<Vec3> positions, std::span<char> absent = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ft::inline collision
