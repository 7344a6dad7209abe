#include "baker/core/edge_strain.h"

#include <algorithm>

#include "baker/core/mesh.h"

namespace ft {

RestEdges rest_edges(std::span<const Vec3> rest, std::span<const Triangle> triangles) {
  RestEdges out;
  for (const Edge& e : unique_edges(triangles)) {
    const double length = (rest[at(e[0])] - rest[at(e[1])]).norm();
    if (!(length > 0)) continue;
    out.edges.push_back(e);
    out.lengths.push_back(length);
  }
  return out;
}

std::vector<double> edge_strains(const RestEdges& rest, std::span<const Vec3> x) {
  std::vector<double> out(rest.edges.size());
  for (std::size_t e = 0; e < out.size(); ++e) {
    const Edge& edge = rest.edges[e];
    out[e] = (x[at(edge[0])] - x[at(edge[1])]).norm() / rest.lengths[e] - 1;
  }
  return out;
}

StrainSummary summary(std::vector<double> strains) {
  StrainSummary out;
  if (strains.empty()) return out;
  double sum = 0;
  for (const double s : strains) sum += s;
  out.mean = sum / static_cast<double>(strains.size());
  out.max = *std::max_element(strains.begin(), strains.end());
  const auto p99 = strains.begin() + static_cast<std::ptrdiff_t>(strains.size() * 99 / 100);
  std::nth_element(strains.begin(), p99, strains.end());
  out.p99 = *p99;
  return out;
}

}  // namespace ft
