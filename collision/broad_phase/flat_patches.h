// Patches of cloth that cannot meet themselves, so that no pairs have to be looked for inside them.
//
// Each patch has a plane on which its rest shape lies spread out, and a frame R (two orthonormal vectors) that follows
// the cloth. Of the cloth's positions as a function of the plane's points, phi, take in each triangle
//   m = smallest eigenvalue of the symmetric part of R^T grad phi.
// Integrated along the straight way between two points of the plane that is R^T (phi(a) - phi(b)) . (a - b) >= m |a -
// b|2, hence |phi(a) - phi(b)| >= m |a - b|: where m is positive, the patch is one-to-one, whatever its edges and
// slivers. A patch with m >= 1/2 (over the stretch that spreading it out has cost) keeps every pair of its features at
// least half as far apart as it is at rest: no neighbours touch (contact_potential.h), and nothing can cross. m is
// concave in the positions, so a straight move between two states that are flat in the same frame stays flat on its
// way.
//
// The way between two points must lie on the patch. So the members of a patch are chosen such that their convex hull on
// the plane is covered once, and all triangles that cover it count for m.
//
// Monotone maps: Minty (1962); that one-to-one follows is the theorem of Noshiro and Warschawski for the plane.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "baker/core/ascending_rows.h"
#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft::inline collision {

class FlatPatches {
 public:
  /// Of triangles over `rest` [m]; cords ({a, b, b}) and slivers are in none. Patches reach as far beyond the middle of
  /// what they are made for as pairs are looked for: `reach` [m], >= 0. Keeps the spans.
  FlatPatches(std::span<const Vec3> rest, std::span<const Triangle> triangles, double reach);

  /// Per patch: its triangles, ascending.
  const AscendingRows& members() const { return members_; }
  std::vector<int> members(int patch) const { return members_.row(patch); }
  /// Per patch: whether no pairs are needed between its members.
  std::span<const char> flat() const { return flat_; }

  /// Sets the frames for a motion that starts at x (per vertex [m]), and takes every patch for flat that is so at x,
  /// with something to spare. x has to stay as it is until the last keep().
  void begin(std::span<const Vec3> x);
  /// Only what is flat at x, too, stays so. Returns whether all did, and appends those that did not to `lost`.
  /// to_spare: by as much as in begin(), not only just.
  bool keep(std::span<const Vec3> x, bool to_spare, std::vector<int>& lost);

 private:
  struct Sides {
    std::array<float, 3> a, b;  ///< from the first corner to the others [m]
  };
  Sides sides(std::span<const Vec3> x, std::size_t triangle) const;
  template <class RestOf, class NowOf>
  float flatness(std::size_t patch, RestOf&& rest_of, NowOf&& now_of) const;

  std::span<const Vec3> rest_;
  std::span<const Triangle> triangles_;
  AscendingRows members_, beside_;           ///< per patch: triangles; both together cover it
  std::vector<std::array<float, 6>> plane_;  ///< per patch: the axes of its plane, in the space of the rest shape
  std::vector<float> least_;                 ///< per patch: what m has to be at least
  std::vector<float> by_sides_;              ///< per triangle: how much m can change, by that of the sides [1/m]
  std::vector<char> flat_;

  // Of the motion that begin() was told of.
  std::vector<std::array<float, 6>> frame_;  ///< per patch: R
  std::vector<float> first_flatness_;        ///< per patch: m at its start
  std::span<const Vec3> first_;              ///< places there [m]
};

}  // namespace ft::inline collision
