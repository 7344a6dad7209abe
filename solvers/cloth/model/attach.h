// Buttons and zips: pins that hold to a garment instead of the body, to another or to their own, each vertex to the
// nearest point of its surface in the bind pose.
#pragma once

#include <span>
#include <vector>

#include "collision/geometry/nearest_point.h"
#include "solvers/cloth/model/cloth_setup.h"

namespace ft::inline solvers {

struct ClothModel;

/// How firmly, by the length of border that a vertex stands for (seam_lengths()).
struct AttachSettings {
  /// N/m2. What holds an opening gives more than a seam: 0.3 mm under the pull of a tight waist (30 N/m). As stiff as a
  /// seam, its short cords go slack and taut within one step of Newton's method, and all cloth moves too slowly.
  double stiffness = 1e5;
  double hold = 2000;  ///< N/m: as a seam's
};

/// For each vertex of a pin of garment `own`: where it holds to garment `to`, in that one's numbering, as both lie at
/// rest. In its own garment that is on the other side of an opening, if there is one: what is about as near along the
/// cloth is not meant.
std::vector<SurfacePoint> anchor_points(std::span<const ClothGarment> garments, std::size_t own, const ClothPin& pin);

/// When each vertex of a pin holds; they are at `rest` [m]. Where a pin opens along a direction its vertices share the
/// time of the fade, each with an even part of its own.
std::vector<HoldSpan> hold_spans(const ClothPin& pin, std::span<const Vec3> rest);

/// Fills topology->attachments from the pins that hold to a garment.
void attach(ClothModel& model);

}  // namespace ft::inline solvers
