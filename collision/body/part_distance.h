// Signed distance of a point to those parts of a surface that it must stay out of: closest point in the parts'
// triangles, sign by the angle-weighted pseudo-normal of the feature hit (Baerentzen & Aanaes 2005). For the feasible
// collider. A part that is an open patch of a larger skin has no distance where the closest point lies on its rim, nor
// deeper than half its thickness.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "collision/geometry/triangle_tree.h"

namespace ft::inline collision {

/// Topology that never changes. Vertices that coincide in the bind pose and belong to one part count as one.
class PartSurface {
 public:
  PartSurface(std::span<const Vec3> bind, std::span<const Triangle> triangles, std::span<const int> part_of_vertex,
              int part_count);

  int part_count() const { return static_cast<int>(trees_.size()); }
  int part_of_triangle(int triangle) const { return part_of_triangle_[static_cast<std::size_t>(triangle)]; }
  bool closed(int part) const { return closed_[static_cast<std::size_t>(part)]; }
  /// Connected piece of the surface (bare touching does not connect), one number per part; parts that share an edge
  /// share it.
  int shell(int part) const { return shell_[static_cast<std::size_t>(part)]; }
  /// Deepest point that counts as inside [m]: infinite for closed parts, half the thickness in the bind pose for
  /// patches.
  double depth_limit(int part) const {
    return closed(part) ? std::numeric_limits<double>::infinity() : half_thickness(part);
  }
  /// Of the body where the part is, in the bind pose [m]; 0 for a part without triangles.
  double half_thickness(int part) const { return half_thickness_[static_cast<std::size_t>(part)]; }
  /// One per vertex: the first vertex of those that count as one with it.
  std::span<const int> representative() const { return representative_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  const TriangleTree& tree(int part) const { return trees_[static_cast<std::size_t>(part)]; }

  struct Answer {
    Vec3 point = Vec3::Zero();   ///< closest point of the parts
    Vec3 normal = Vec3::Zero();  ///< unit pseudo-normal there, outwards
    double distance = 0;         ///< signed [m], negative inside
    int part = -1;
  };
  /// Positions now, and this surface's trees refitted to them (those of the parts asked for).
  struct Pose {
    std::span<const Vec3> positions;
    std::span<const TriangleTree> trees;
  };
  /// Distance to the union of parts (of one shell), looked for no farther than reach [m]. allowed[part] tells which
  /// parts count as neighbours at a rim. hint, a triangle of one of the parts or -1, only makes it faster; it becomes
  /// the triangle found.
  std::optional<Answer> distance(const Vec3& p, std::span<const int> parts, std::span<const char> allowed, double reach,
                                 const Pose& pose, int& hint) const;
  /// The answer for a closest point that is known already; nothing when it lies on a rim or too deep.
  std::optional<Answer> judge(const Vec3& p, const TriangleTree::Hit& hit, std::span<const char> allowed,
                              std::span<const Vec3> positions) const;

 private:
  Vec3 face_normal(int triangle, std::span<const Vec3> positions) const;
  double measure_half_thickness(int part, std::span<const Vec3> bind, const TriangleTree& skin) const;

  std::vector<Triangle> triangles_;  ///< in representatives
  std::vector<int> part_of_triangle_;
  std::vector<std::array<int, 3>> neighbours_;  ///< across edge k (corner k to k+1); -1 none
  std::vector<char> rim_vertex_;                ///< on an edge that has one triangle only
  Adjacency around_;                            ///< vertex -> triangles
  std::vector<int> representative_;
  std::vector<char> closed_;
  std::vector<int> shell_;
  std::vector<double> half_thickness_;
  std::vector<double> outward_;  ///< per part: -1 where the shell's triangles face inwards
  std::vector<TriangleTree> trees_;
};

}  // namespace ft::inline collision
