// For `check` and `preview`: what is known of garments from their caches.
#pragma once

#include "baker/core/edge_strain.h"
#include "baker/systems/interface/system.h"

namespace ft::inline baker {

/// Garments that were solved together are judged together.
Result<std::vector<std::unique_ptr<JudgedGroup>>> judge_cloths(const CachedBake& bake);

/// The lengths from which the bake of a cloth measured its strain, in a mesh at rest and the triangles that it is split
/// into; pattern_scale as in CacheTrack.
RestEdges rest_edges_of(const Mesh& rest, std::span<const Triangle> triangles, double pattern_scale);

}  // namespace ft::inline baker
