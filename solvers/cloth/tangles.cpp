#include "solvers/cloth/tangles.h"

#include <algorithm>

namespace ft {
namespace {

/// Edges around a crossing within which pairs are left out: a contour moves about this far while one substep lasts.
constexpr int k_rings = 2;

}  // namespace

std::vector<Crossing> own_crossings(const ClothModel& model, std::vector<Crossing> within) {
  std::erase_if(within, [&](const Crossing& c) {
    return !model.self_collides[at(c.edge[0])] || !model.self_collides[at(c.triangle[0])] || model.sewn.together(c);
  });
  return within;
}

void mark_tangled(const ClothModel& model, std::span<const Crossing> crossings, std::vector<char>& tangled) {
  tangled.assign(at(model.vertex_count()), 0);
  for (const Crossing& c : crossings) {
    for (const int v : c.edge) tangled[at(v)] = 1;
    for (const int v : c.triangle) tangled[at(v)] = 1;
  }
  for (int ring = 0; ring < k_rings && !crossings.empty(); ++ring) {
    const std::vector<char> before = tangled;
    for (const Edge& e : model.rest_edges.edges)
      if (before[at(e[0])] != 0 || before[at(e[1])] != 0) tangled[at(e[0])] = tangled[at(e[1])] = 1;
  }
}

bool any_tangled(std::span<const char> tangled) {
  return std::any_of(tangled.begin(), tangled.end(), [](char t) { return t != 0; });
}

bool among_tangled(const Crossing& crossing, std::span<const char> tangled) {
  const auto is = [&](int v) { return tangled[at(v)] != 0; };
  return std::all_of(crossing.edge.begin(), crossing.edge.end(), is) &&
         std::all_of(crossing.triangle.begin(), crossing.triangle.end(), is);
}

}  // namespace ft
