// What a frame tells the user of a body that is torn, and of a walk that was cut short.
#pragma once

#include <span>

#include "solvers/cloth/model/cloth_model.h"
#include "solvers/cloth/model/cloth_motion.h"

namespace ft::inline solvers {

struct TornFrame {
  std::span<const char> torn;  ///< per vertex of the collider, as TornBody::find(); one at least
  bool wrecked = false;        ///< so much is torn that the cloth was only taken along
  std::span<const Vec3> body;  ///< at the frame's end [m]
  int frame = 0;
};

/// What of the body was not met because it is torn, at the cloth's vertex that is nearest.
Incident torn_incident(const ClothModel& model, const ClothMotion& motion, const TornFrame& frame);

/// A frame that was cut short, at the cloth that is stretched most. hurried: it reached its limit of work; else cloth
/// was slowed down that is faster than the substeps can follow.
Incident haste_incident(const ClothModel& model, const ClothMotion& motion, bool hurried, int frame);

}  // namespace ft::inline solvers
