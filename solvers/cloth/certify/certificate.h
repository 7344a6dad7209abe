// What is certified of a frame of cloth, from positions alone: exact crossings, what of the collider is absent, strain,
// energy, depth in the drawn body. For cloth_solver.cpp, which walks a frame anew when a crossing could have been
// avoided. Nothing here moves the cloth; certify() only decides what of the collider is absent and which vertices are
// tangled from here on.
#pragma once

#include <optional>
#include <span>

#include "collision/check/checked_surface.h"
#include "solvers/cloth/advance/body_advance.h"
#include "solvers/cloth/advance/body_ahead.h"
#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {

class Certificate {
 public:
  explicit Certificate(const ClothModel& model);

  /// Counts the crossings at a frame's end. What of the collider is clear of the cloth comes back, and tangles are
  /// marked anew. Returns the number of crossings that no tangle explains.
  int certify(const BodyPose& body, ClothMotion& motion, FrameReport& report);

  /// Strain, energy, seams that are open at that time [s] and should not be, and what is inside the drawn body [m], or
  /// inside that of the last certify(); then sorts the incidents, worst first, and keeps at most 16.
  void describe(double time, std::span<const Vec3> drawn, const ClothMotion& motion, FrameReport& report);

 private:
  const ClothModel& model_;
  // Scratch: box trees, of which the order of triangles is kept from frame to frame.
  CheckedSurface cloth_, collider_, drawn_;
  std::optional<CheckedSurface> solid_collider_, solid_drawn_;  ///< without sheets, where there are some
};

}  // namespace ft::inline solvers
