// Creases of joints that bend far: knee pits, elbow pits, groins. Jointed parts touch, so the carver leaves them to
// each other; but when the joint closes, the two skins fold into each other from the crease on, and cloth that lies
// there has no room. Here both give way to the plane that halves the joint's angle: from a body thickness away from
// each other on, which is where they meet at a right angle, they keep a slot of the gap between them. Nearer to the
// joint they stay as drawn, and in the bind pose nothing moves.
#pragma once

#include <span>
#include <vector>

#include "baker/core/trajectory.h"
#include "collision/body/part_distance.h"

namespace ft::inline collision {

class Creases {
 public:
  Creases() = default;
  /// Joints are pairs of a part and its parent that fold and touch in the bind pose. gap: room that their skins keep
  /// [m]. The surface has to outlive this.
  Creases(const PartSurface& surface, std::span<const SurfacePart> parts, std::span<const int> part_of_vertex,
          std::span<const Vec3> bind, double gap);
  /// Moves the vertices that have to give way in this pose. Small motions of the pose give small motions of them.
  void open(std::span<Vec3> positions) const;

 private:
  /// Vertices of a part (representatives), as they are in the bind pose.
  struct Part {
    std::vector<int> vertices;
    std::vector<Vec3> bind;
    std::vector<int> samples;  ///< some of the vertices, from which the part's motion is read
    std::vector<Vec3> sample_bind;
  };
  struct Joint {
    int part[2];                  ///< the second lies on the side to which the axis points
    Vec3 place, axis;             ///< of the joint, bind pose
    std::vector<double> keep[2];  ///< per vertex of each part: least distance from the plane, on its own side [m]
    double reach = 0;             ///< how deep the parts are looked for in each other [m]
  };
  std::vector<double> distances_to(int other, const Part& own, std::span<const Vec3> bind, double reach) const;
  void push_apart(const Joint& joint, const Eigen::Isometry3d moves[2], std::span<const Vec3> drawn,
                  std::vector<TriangleTree>& trees, std::span<Vec3> positions) const;

  const PartSurface* surface_ = nullptr;
  double gap_ = 0;
  std::vector<Part> parts_;
  std::vector<Joint> joints_;
};

}  // namespace ft::inline collision
