// How a patch of flat_patches.h is cut out of a garment's rest shape: spread out on a plane by projection along its
// mean normal, as far as triangles can be followed from the seed that face the same way, and of these as many members
// as have a convex hull that is covered once.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft::inline collision {

struct SpreadPatch {
  std::vector<int> members;  ///< triangles, ascending; empty: there is no patch
  std::vector<int> cover;    ///< all triangles that touch the convex hull of the members on the plane, ascending
  std::array<Vec3, 2> axes;  ///< of the plane, orthonormal
  double stretch = 1;        ///< how much longer the rest shape is than its projection, at most [1]
};

class PatchBuilder {
 public:
  static constexpr float k_facing = 0.8f;  ///< cosine of the angle between a member or cover and the plane, at least

  /// See FlatPatches. Keeps the spans.
  PatchBuilder(std::span<const Vec3> rest, std::span<const Triangle> triangles, double reach);
  /// Vertices to spread patches about: every vertex of a triangle is near one.
  std::vector<int> seeds() const;
  SpreadPatch spread(int seed) const;

 private:
  double spacing(int vertex) const;
  bool usable(int triangle, const Vec3& normal) const;
  struct Spread;
  void reach(int first, int seed, const Vec3& normal, const std::array<Vec3, 2>& axes, Spread& found) const;
  bool lies_once(const Spread& found) const;
  void choose_members(Spread& found) const;

  std::span<const Vec3> rest_;
  std::span<const Triangle> triangles_;
  double reach_;
  Adjacency around_;                        ///< vertex -> triangles
  std::vector<std::array<int, 3>> across_;  ///< per triangle: the one behind the side from each corner to the next; -1
  std::vector<double> side_;                ///< per vertex: mean length of the sides around it [m]
};

}  // namespace ft::inline collision
