// How many substeps a frame takes.
#pragma once

#include <span>

#include "solvers/cloth/model/cloth_model.h"
#include "solvers/cloth/model/cloth_motion.h"

namespace ft::inline solvers {

/// Between the setup's least and most: so many that neither the body moves too far against cloth that is near, nor the
/// cloth turns too far, nor its vertices pass too many of each other. duration: of the frame [s]; body: its vertices at
/// the frame's start and end [m], empty for none; deep: where it is not 0 no garment meets them, and they do not count;
/// empty: all do.
int substep_count(const ClothModel& model, const ClothMotion& motion, double duration, std::span<const Vec3> body_t0,
                  std::span<const Vec3> body_t1, std::span<const char> deep_t0 = {},
                  std::span<const char> deep_t1 = {});

/// Slows vertices down that would move by far more in a substep [s], against the mean motion of their garment, than
/// substep_count() is after. Returns whether there were any.
bool slow_down(const ClothModel& model, double h, ClothMotion& motion);

}  // namespace ft::inline solvers
