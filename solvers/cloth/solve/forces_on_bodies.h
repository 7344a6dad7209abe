// What garments do to a primary that is several bodies in one, told of each body. The whole force of a garment is known
// from its change of momentum, which is exact; what its contacts and pins press with says where it goes. What Newton's
// method has left over between the two is shared out as these are.
#pragma once

#include <span>
#include <vector>

#include "baker/core/wrench.h"
#include "solvers/base/solver.h"

namespace ft::inline solvers {

struct ClothModel;

/// What the pieces of a substep add up to, of one garment on one body.
struct OnBody {
  Wrench impulse;           ///< about the origin [N s]
  double peak = 0;          ///< largest force of a piece [N]
  double contact_time = 0;  ///< s
};

/// Rows garment after garment, a body after the other. total: per garment; known: per row what contacts and pins tell;
/// wearer: per garment its body, which gets all where nothing is told.
std::vector<Wrench> share_out(std::span<const Wrench> total, std::span<const Wrench> known,
                              std::span<const int> wearer);

/// Per garment: which body of the setup wears it; all 0 where there is one.
std::vector<int> wearer_bodies(const ClothModel& model);

/// Adds what a substep did, row by row, of a frame that takes `duration` [s]; torques are about the origin until the
/// frame is over.
void add_forces(const ClothModel& model, std::span<const OnBody> step, double duration, FrameReport& report);

/// Ends a frame: torques about the centre of each body, which the collider [m] has at the frame's end; bodies that a
/// garment does not meet are left out.
void finish_forces(const ClothModel& model, std::span<const Vec3> collider, FrameReport& report);

}  // namespace ft::inline solvers
