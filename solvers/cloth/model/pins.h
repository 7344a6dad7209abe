// Pins: where they are on the body, and where the body takes them.
#pragma once

#include <span>

#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {

/// Fills pins from those of the garments that do not hold to a garment, as all lie in the bind pose.
void pin(ClothModel& model);

/// The point of the body's surface nearest to `place`, with the offset in that triangle's frame; a fixed place without
/// a body.
PinPoint bind_pin(int vertex, const Vec3& place, std::span<const Vec3> body, std::span<const Triangle> triangles);

/// Where the pins are, from the drawn body's positions.
void pin_targets(const ClothModel& model, std::span<const Vec3> drawn, std::span<Vec3> targets);

/// Something lets go or takes hold at once between the times [s]. The integrator is then started anew by a step of
/// implicit Euler: the history knows nothing of the new force, and cloth that is let go would stay behind free fall by
/// half a substep for good.
bool hold_jumps(const ClothModel& model, double time_t0, double time_t1);

}  // namespace ft::inline solvers
