// The body as the cloth solver meets it: the drawn pose of the trajectory, refined, made feasible, and during the
// pre-roll drawn in where garments start inside it, so that the growing surface pushes them out without a crossing.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "baker/core/trajectory.h"
#include "collision/body/feasible_poses.h"

namespace ft::inline solvers {

class MovingCollider {
 public:
  explicit MovingCollider(std::shared_ptr<const FeasiblePoses> poses);

  int vertex_count() const { return poses_->collider().vertex_count(); }
  std::span<const Triangle> triangles() const { return poses_->collider().triangles(); }
  std::span<const int> part_of_vertex() const { return poses_->collider().part_of_vertex(); }
  const Trajectory& trajectory() const { return poses_->body(); }
  /// What of the collider, and of the drawn body, has an inside: all but sheets.
  std::span<const Triangle> solid_triangles() const { return has_sheets_ ? std::span(solid_) : triangles(); }
  std::span<const Triangle> solid_drawn_triangles() const {
    return has_sheets_ ? std::span(solid_drawn_) : std::span(trajectory().surface().triangles);
  }
  bool has_sheets() const { return has_sheets_; }

  /// Draws the body in at the start of the pre-roll so that this cloth (placed by bind_to_start) does not cross it and
  /// keeps about `clearance` [m]. Returns how deep the deepest point was inside [m]. Without a pre-roll nothing is
  /// drawn in.
  double draw_in_for(std::span<const Vec3> points, std::span<const Triangle> cloth, double clearance);
  /// Largest inset [m].
  double largest_inset() const { return largest_inset_; }

  /// The bind pose of the collider, before anything gives way.
  void refined_bind(std::span<Vec3> positions) const;
  void drawn(double time, std::vector<Vec3>& positions) const;
  /// The drawn pose with the collider's vertices, before anything gives way.
  std::vector<Vec3> refined(double time) const;
  /// Feasible positions, from the drawn ones at the same time. absent: per vertex, where the body is too deep in itself
  /// for cloth to meet it, see FeasibleCollider::evaluate(); null: not asked for.
  CarveReport feasible(double time, std::span<const Vec3> drawn, std::vector<Vec3>& positions,
                       std::vector<char>* absent = nullptr) const;

 private:
  /// 1 at the start of the pre-roll, 0 from 60 % of it on.
  double inset_share(double time) const;

  std::shared_ptr<const FeasiblePoses> poses_;
  bool has_sheets_ = false;
  std::vector<Triangle> solid_, solid_drawn_;  ///< where there are sheets
  std::vector<double> inset_;                  ///< per collider vertex [m]; empty: none
  double largest_inset_ = 0;
};

}  // namespace ft::inline solvers
