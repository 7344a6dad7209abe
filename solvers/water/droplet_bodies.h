// Bodies that droplets meet as they fly, the same for all kinds of water: what would go into a body in a step is
// stopped at its surface, where both are at that moment. It loses the velocity with which it comes against the body
// (water wets and does not bounce), is slowed along it by friction, and goes on from there for the rest of the step.
// Only what comes from outside is stopped. A droplet that begins inside, as one that is thrown in a cell of which a
// foot takes a part, flies on until it is out: moved to the nearest surface it would jump by up to a cell, a surface
// with openings has no inside to be moved out of, and inside of a body nobody sees it. Approximated: droplets are
// points; bodies feel nothing of them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision/geometry/triangle_tree.h"
#include "solvers/water/water_body.h"

namespace ft::inline solvers {

class DropletBodies {
 public:
  /// Coefficient of friction, as of surfaces that water lubricates [1].
  static constexpr double k_friction = 0.1;
  /// Droplets keep so far from what they have met [m].
  static constexpr double k_skin = 1e-6;

  /// Of a frame. origin: where in the world droplets' places begin [m]. What is given has to stay.
  DropletBodies(std::span<const DrivenBody> driven, std::vector<const FloatingBody*> floats,
                const Vec3& origin = Vec3::Zero(), double friction = k_friction);

  bool empty() const { return bodies_.empty(); }
  /// The step that comes: between two shares of the frame, 0 to 1; what floats goes between poses in the droplets'
  /// axes.
  void set_step(double share0, double share1, std::span<const RigidPose> from = {}, std::span<const RigidPose> to = {});
  /// Droplets have gone from `starts` to where they are in the step, which takes dt [s]; where `since` is given, each
  /// in that part of it which begins there, 0 to 1.
  void stop(std::span<Droplet> droplets, std::span<const Vec3> starts, double dt, std::span<const double> since = {});

 private:
  struct Body {
    const DrivenBody* driven = nullptr;  ///< or
    const FloatingBody* floating = nullptr;
    /// Driven: of the kept triangles, over the frame; floating: `first`, all, in its own axes [m].
    std::vector<Vec3> first, last;
    std::vector<Triangle> triangles;  ///< that are kept
    std::vector<Vec3> corners;        ///< driven: least and most of each triangle in the window [m]
    std::vector<Triangle> boxes;      ///< from those, for the tree
    TriangleTree tree;                ///< over boxes, or of the floating body in its own axes
    RigidPose pose0, pose1;           ///< floating: of the step
    double reach = 0, slack = 0;      ///< floating: from its middle; by how much a step's turn bends ways [m]
  };
  struct Hit;

  void cover(const Box& paths, double longest);
  void keep_near(Body& body);
  void set_window();
  bool near_driven(const Box& path) const;
  static bool near_floating(const Body& body, const Box& path);
  bool near_any(const Box& path) const;
  Vec3 corner(const Body& body, int vertex, double since) const;
  Hit first_hit(const Vec3& from, const Vec3& to, double since) const;
  void meet(Droplet& droplet, const Vec3& start, double since, double dt) const;

  std::vector<DrivenBody> driven_;
  std::vector<Body> bodies_;
  Vec3 origin_;
  double friction_, share0_ = 0, share1_ = 1;  ///< of the step
  double window0_ = 0, window1_ = -1;          ///< shares of the frame for which the driven ones' trees are set
  double way_ = 0;                             ///< the longest of a driven vertex in the frame [m]
  Box covered_;                                ///< triangles that come into it in the frame are kept
  Box seen_;                                   ///< of the grid
  double cell_ = 1;                            ///< of the grid [m]
  std::array<int, 3> cells_{};
  std::vector<char> driven_in_;  ///< of each cell: whether a driven triangle comes into it in the frame
};

}  // namespace ft::inline solvers
