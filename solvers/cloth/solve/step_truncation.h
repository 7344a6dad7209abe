// What of a Newton direction is done: what keeps every vertex inside the ball in which the list of pairs is complete,
// and every pair apart. Clusters of vertices are cut alike.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "collision/step_bound/common_motion.h"
#include "collision/step_bound/pair_obstacles.h"
#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {

class StepTruncation {
 public:
  /// Told where a displacement leads the cloth [m]; false: the list of pairs has been extended, look again.
  using PairsSuffice = std::function<bool(std::span<const Vec3> x)>;

  explicit StepTruncation(const ClothModel& model);
  /// Slows what vertices that lie very near each other, or near an edge of their triangle, do against each other, so
  /// that no step takes one past another. all: places, the cloth's first; direction: the cloth's displacements [m].
  void damp_relative_motion(std::span<const Vec3> all, std::span<Vec3> direction) const;
  /// Shortens the direction to what stays in the balls, fills `cut` with what may be done of it and the front of
  /// `trial` with where that leads [m]. pairs_suffice may be empty.
  void truncate(ContactPotential& contact, std::span<const Vec3> all, const MotionBounds& balls,
                const PairsSuffice& pairs_suffice, std::span<Vec3> direction, std::span<Vec3> cut,
                std::span<Vec3> trial);

  /// What is in the way of a direction that truncate() has shortened.
  std::vector<PairObstacle> obstacles(ContactPotential& contact, std::span<const Vec3> all,
                                      std::span<const Vec3> direction);

 private:
  /// A vertex of a triangle that at rest lies very near the opposite edge, in no cluster with its ends.
  struct Cap {
    int vertex;
    Edge base;
    double place;   ///< of the nearest point of the base: (1 - place) base[0] + place base[1]
    double height;  ///< at rest [m]
  };
  const ClothModel& model_;
  std::vector<Cap> caps_;
  CommonMotion common_motion_;
  std::vector<double> share_, length_;
  PairPlaces near_;
};

}  // namespace ft::inline solvers
