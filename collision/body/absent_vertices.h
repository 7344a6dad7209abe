// What of a body is too deep in the body itself to be a collider: a hand in a thigh, an upper arm in the chest. Carving
// (carver.h) moves what is inside a larger part onto that part's surface; from some depth on that leaves a limb pressed
// flat, which jumps when another side of the larger part becomes the nearest. Such vertices are absent: cloth does not
// meet a feature that one of them belongs to. A function of the pose alone, so that nothing is remembered from frame to
// frame. A vertex is absent where
//   - it had to move too far, or is inside and connected to such a one without having been moved (carving does not know
//     a way out of the middle of a trunk);
//   - it looks at a larger part that is nearer than the cloth between needs: in an armpit, where skin folds on
//     skin and carving leaves what touches in the bind pose as it is. Not where the two are jointed (creases.h).
// What stands still (SurfacePart::fixed) is never absent: a chair on the ground stays a chair. Nor is a sheet, which
// also makes nothing absent: whoever wears it is not inside it.
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/trajectory.h"
#include "collision/body/part_distance.h"

namespace ft::inline collision {

class AbsentVertices {
 public:
  AbsentVertices() = default;
  /// The surface has to outlive this. rank: per part, 0 is the largest. deepest: farthest that a vertex may have been
  /// moved by carving [m]; of a thick part more, so far that it is not pressed flat; room: what cloth needs between two
  /// surfaces [m].
  AbsentVertices(const PartSurface& surface, std::span<const Vec3> bind, std::span<const int> part_of_vertex,
                 std::span<const SurfacePart> parts, std::span<const int> rank, double deepest, double room);
  /// before and after carving, per vertex [m]. Fills absent with 0 and 1. Thread-safe.
  void find(std::span<const Vec3> before, std::span<const Vec3> after, std::span<char> absent) const;

 private:
  class LargerParts;
  void find_deep(std::span<const Vec3> before, std::span<const Vec3> after, std::span<char> absent) const;
  void find_folds(std::span<const Vec3> after, std::span<char> absent) const;
  /// Where one bends against the other there is no fold (creases.h).
  bool jointed(int part, int other) const {
    return parents_[static_cast<std::size_t>(part)] == other || parents_[static_cast<std::size_t>(other)] == part;
  }

  const PartSurface* surface_ = nullptr;
  std::vector<int> part_of_vertex_, parents_;  ///< parents of parts
  std::vector<char> stays_, sheet_;            ///< of parts: never absent; SurfacePart::sheet
  std::vector<int> rank_of_vertex_, rank_;     ///< rank_: of parts
  Adjacency neighbours_;
  TriangleTree tree_;                     ///< of what has an inside
  std::vector<float> deepest_of_vertex_;  ///< m
  double room_ = 0;
};

}  // namespace ft::inline collision
