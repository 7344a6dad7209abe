// Zones of cloth that moves as one. Where surfaces would meet on their way, their vertices are given one common motion,
// the body's where the body is in it: what moves alike cannot meet. Provot's impact zones (1997) reduced to
// translations, and harmless here: the carry is only where the solve starts from, and what the vertices of a step have
// in common only the part of it that is made at once.
#pragma once

#include <span>
#include <vector>

#include "baker/core/disjoint_sets.h"
#include "collision/broad_phase/contact_pairs.h"
#include "collision/geometry/pair_geometry.h"
#include "collision/step_bound/vertex_clusters.h"

namespace ft::inline collision {

class MotionZones {
 public:
  /// No zones among so many cloth vertices but the clusters; vertices of the common numbering past them are the body's.
  void clear(int cloth_vertex_count, const VertexClusters& clusters);
  /// The cloth of a pair moves as one from now on, with the body if the body is in the pair. x: the pair's places, d:
  /// its motions [m].
  void join(PairKind kind, const Stencil& stencil, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& d);
  /// Gives every zone its motion: the mean of the body's where it was met, else of what its vertices had [m].
  void apply(std::span<Vec3> motion) const;

  /// The zone of a cloth vertex, named by the smallest vertex in it.
  int root(int vertex) const { return zones_.root(vertex); }
  /// A place where a zone met the body.
  struct BodyMotion {
    int vertex;       ///< of the cloth
    int body_vertex;  ///< of the common numbering
    Vec3 motion;      ///< m
  };
  std::span<const BodyMotion> body_met() const { return body_; }

 private:
  DisjointSets zones_;
  std::vector<BodyMotion> body_;
};

}  // namespace ft::inline collision
