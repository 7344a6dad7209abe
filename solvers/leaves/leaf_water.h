// The waters that leaves float on, over one frame: heights of their surfaces at the ends of a few slices, straight in
// between, and how fast they rise and flow.
//
// A surface is a grid over x and z whose vertices go up and down: row after row along x, as its mesh has them. What a
// leaf feels of it is the plane that fits under the leaf, from four places about its middle which have the second
// moments of its area: waves shorter than the leaf are averaged, as by the leaf itself.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "solvers/leaves/leaf_bodies.h"

namespace ft::inline solvers {

/// The water under a leaf.
struct WaterPatch {
  double level = 0;             ///< of its middle [m]
  Vec2 slope = Vec2::Zero();    ///< rise along x and z [1]
  Vec3 flow = Vec3::Zero();     ///< y: how fast the level rises at this place; x, z: of the water [m/s]
  Vec3 normal = Vec3::UnitY();  ///< unit, upwards
  Vec3 turning = Vec3::Zero();  ///< of the normal, and of the water about it [rad/s]
  /// Of the surface under something that goes by at a velocity [m/s].
  double rising(const Vec3& velocity) const { return flow.y() + slope.x() * velocity.x() + slope.y() * velocity.z(); }
  /// Of a place in its plane [m].
  double height_at(const Vec3& middle, const Vec3& place) const {
    return level + slope.x() * (place.x() - middle.x()) + slope.y() * (place.z() - middle.z());
  }
};

class LeafWaters {
 public:
  /// waters have to stay. What is no such grid is left out; fault_of() says so.
  explicit LeafWaters(std::span<const LeafWater> waters);
  /// Empty: leaves can float on it.
  static std::string fault_of(const LeafWater& water);

  bool any() const { return !waters_.empty(); }
  /// Times are seconds from the shot's first frame.
  void begin_frame(double t0, double t1);
  /// Within `share` of a slice, under a leaf whose middle is at `place` and whose places lie `radius` away [m]. None
  /// where there is no water; one that floats is on the nearest water, which beyond its rim is as high as there.
  std::optional<WaterPatch> under(const Vec3& place, double radius, int slice, double share, bool floats) const;

 private:
  struct Water {
    const LeafWater* setup = nullptr;
    Vec2 origin = Vec2::Zero(), cell = Vec2::Zero();
    int nx = 0, nz = 0;  ///< vertices
    /// At the ends of the slices, first the frame's start: heights [m], how fast they rise [m/s].
    std::array<std::vector<double>, LeafBodies::k_slices + 1> height, rise;
    std::array<std::vector<Vec3>, 2> flow;  ///< at the frame's ends [m/s]
    /// Of the vertices' places on the grid; over a cavity, into which vertices are drawn, straight across. places: room
    /// to work in.
    std::vector<double> heights_at(double time, std::vector<Vec3>& places) const;
    /// How far outside a place is [m]; 0: within.
    double outside(const Vec3& place) const;
  };
  static std::optional<Water> grid_of(const LeafWater& water);

  std::vector<Water> waters_;
};

}  // namespace ft::inline solvers
