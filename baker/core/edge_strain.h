// How far a cloth's edges are stretched against their rest length: what the certificate, `check` and the preview's
// colours all mean by strain. Edges without a rest length have no strain and are left out.
#pragma once

#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft {

struct RestEdges {
  std::vector<Edge> edges;
  std::vector<double> lengths;  ///< of each edge at rest, > 0 [m]
};

/// Unique edges, sorted, with their lengths in `rest` [m].
RestEdges rest_edges(std::span<const Vec3> rest, std::span<const Triangle> triangles);

/// Per edge |xi - xj| / rest length - 1; negative where it is compressed [1].
std::vector<double> edge_strains(const RestEdges& rest, std::span<const Vec3> x);

struct StrainSummary {
  double mean = 0, p99 = 0, max = 0;  ///< 1; all 0 without edges
};

StrainSummary summary(std::vector<double> strains);

}  // namespace ft
