#include "solvers/leaves/leaf_bodies.h"

#include <algorithm>
#include <cmath>

#include "collision/check/checked_surface.h"

namespace ft::inline solvers {
namespace {

/// Less than this in a slice is standing still [m].
constexpr double k_still = 1e-9;

double farthest(std::span<const Vec3> a, std::span<const Vec3> b) {
  double squared = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squared = std::max(squared, (b[i] - a[i]).squaredNorm());
  return std::sqrt(squared);
}

}  // namespace

LeafBodies::LeafBodies(std::span<const LeafObstacle> obstacles) : obstacles_(obstacles), bodies_(obstacles.size()) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    const auto& triangles = obstacles_[b].trajectory->surface().triangles;
    body.closed = CheckedSurface(triangles).closed();
    for (const Edge& e : unique_edges(triangles)) body.edges.push_back({{-1, -1}, e});
    body.edges_of.resize(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const int i = triangles[t][k], j = triangles[t][(k + 1) % 3];
        const Edge e{std::min(i, j), std::max(i, j)};
        const auto found = std::lower_bound(body.edges.begin(), body.edges.end(), e,
                                            [](const Side& s, const Edge& wanted) { return s.edge < wanted; });
        body.edges_of[t][k] = static_cast<int>(found - body.edges.begin());
        found->triangles[found->triangles[0] < 0 ? 0 : 1] = static_cast<int>(t);
      }
  }
}

void LeafBodies::begin_frame(double t0, double t1) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    const LeafObstacle& obstacle = obstacles_[b];
    if (obstacle.fixed && body.sampled) continue;
    const auto& surface = obstacle.trajectory->surface();
    const auto sample = [&](std::size_t k) {
      body.places[k].resize(at(surface.vertex_count()));
      obstacle.trajectory->sample(t0 + (t1 - t0) * static_cast<double>(k) / k_slices, body.places[k]);
    };
    // Always from the same pose: the order of the triangles must not hang on the frame at which a bake goes on.
    const auto grow = [&](std::size_t k) {
      if (body.trees[k].empty()) body.trees[k] = TriangleTree(bind_pose_of(*obstacle.trajectory), surface.triangles);
      body.trees[k].refit(body.places[k], surface.triangles);
    };
    const std::vector<Vec3> before = body.places[0];
    sample(0);
    body.moves = false;
    body.box = bounds(body.places[0]);
    for (std::size_t k = 1; k <= k_slices && !obstacle.fixed; ++k) {
      sample(k);
      body.way[k - 1] = farthest(body.places[k - 1], body.places[k]);
      body.moves = body.moves || body.way[k - 1] > k_still;
      body.box.include(bounds(body.places[k]));
    }
    const bool same = body.sampled && farthest(before, body.places[0]) == 0 && !body.trees[0].empty();
    if (!same) grow(0);
    if (body.moves)
      for (std::size_t k = 1; k <= k_slices; ++k) grow(k);
    body.sampled = true;
  }
}

}  // namespace ft::inline solvers
