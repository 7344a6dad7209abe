// Segments of strands that went through a sheet in a step. A sheet has no inside: of a segment that is through one, it
// can no longer be told from which side it came. So what went through is found right after the step, with the place
// where it did, and the step is done again with a plane there.
#pragma once

#include <optional>

#include "solvers/hair/hair_bodies.h"

namespace ft::inline solvers {

/// Both ends of a segment at the start of a step and at its end.
struct SegmentStep {
  Vec3 a, b, a_after, b_after;  ///< m
};

/// Where a segment that is through none of the sheets at a step's start, and is at its end, first went over an edge of
/// one, or with an end through a triangle. The surface's normal is towards the segment's side, its gap above 0.
/// Everything goes in straight lines.
std::optional<NearEdge> find_sheet_passage(const HairBodies& bodies, const SegmentStep& segment);

}  // namespace ft::inline solvers
