// Bodies and meshes that torture scenes are made of: closed surfaces of revolution, boxes, bodies of rigid parts that
// move by formula, and cloth as grids over a function.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "baker/core/mesh.h"
#include "tests/support/scripted_body.h"

namespace ft::torture {

struct Shape {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside
};

/// Profile of (radius, height) turned around the y axis. Open profiles run from the top to the bottom and begin and end
/// on the axis; closed ones run downwards where the radius is largest.
Shape lathe(const std::vector<Vec2>& profile, bool closed, int segments);
/// From `top` to `bottom` along the y axis, hemispheres included [m].
Shape capsule(double top, double bottom, double radius, int rings, int segments);
/// Centred at the origin; sides in m.
Shape box(const Vec3& sides);
Shape moved(Shape shape, const Vec3& by);

using Pose = Eigen::Isometry3d;
using RigidMotion = std::function<Pose(double time)>;
Pose shift(const Vec3& by);
/// Turned around an axis through `pivot` [rad].
Pose turn(const Vec3& pivot, const Vec3& axis, double angle);

/// Body of rigid parts, each on its own path. Sizes fall a little from part to part, so that it is clear who gives way.
class RigidParts {
 public:
  RigidParts& add(const std::string& name, const Shape& shape, RigidMotion motion);
  std::shared_ptr<ScriptedBody> build() const;

 private:
  Surface surface_;
  std::vector<Vec3> points_;
  std::vector<RigidMotion> motions_;
};

/// 0 before `from`, 1 after `to`, a smooth step between [s].
double ease(double time, double from, double to);

/// Grid of columns x rows cells over place(s, t), s and t in [0, 1]; alternating diagonals. Vertex (i, j) is i +
/// (columns + 1) j; with `round` the last column is the first one again and a row has `columns` vertices.
Mesh grid(const std::string& name, int columns, int rows, bool round, const std::function<Vec3(double, double)>& place);

}  // namespace ft::torture
