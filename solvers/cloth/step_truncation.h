// What of a Newton direction is done: what keeps every vertex inside the ball in which the list of pairs is complete,
// and every pair apart. Clumps of vertices are cut alike.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "collision/common_motion.h"
#include "solvers/cloth/cloth_model.h"

namespace ft {

class StepTruncation {
 public:
  /// Told where a displacement leads the cloth [m]; false: the list of pairs has been extended, look again.
  using PairsSuffice = std::function<bool(std::span<const Vec3> x)>;

  explicit StepTruncation(const ClothModel& model) : model_(model) {}
  /// Slows what the vertices of clumps do against each other, so that no step takes one past another. all: the cloth
  /// comes first [m].
  void calm_clumps(std::span<const Vec3> all, std::span<Vec3> direction) const;
  /// Shortens the direction to what stays in the balls, fills `cut` with what may be done of it and the front of
  /// `trial` with where that leads [m]. pairs_suffice may be empty.
  void truncate(ContactPotential& contact, std::span<const Vec3> all, const MotionBounds& balls,
                const PairsSuffice& pairs_suffice, std::span<Vec3> direction, std::span<Vec3> cut,
                std::span<Vec3> trial);

 private:
  const ClothModel& model_;
  CommonMotion common_motion_;
  std::vector<Vec3> common_;
  std::vector<double> share_, length_;
  ContactPairs near_;
};

}  // namespace ft
