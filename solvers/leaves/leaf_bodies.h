// The bodies that leaves meet, over one frame: their places at the ends of a few slices of it, straight in between, and
// a box tree for each slice. A body that stands still is looked at once.
#pragma once

#include <span>
#include <vector>

#include "collision/geometry/triangle_tree.h"
#include "solvers/leaves/leaves_setup.h"

namespace ft::inline solvers {

class LeafBodies {
 public:
  static constexpr int k_slices = 4;

  /// obstacles have to stay.
  explicit LeafBodies(std::span<const LeafObstacle> obstacles);
  /// Times are seconds from the shot's first frame.
  void begin_frame(double t0, double t1);

  int count() const { return static_cast<int>(bodies_.size()); }
  const LeafObstacle& obstacle(int body) const { return obstacles_[at(body)]; }
  /// In this frame.
  bool moves(int body) const { return bodies_[at(body)].moves; }
  bool closed(int body) const { return bodies_[at(body)].closed; }
  std::span<const Triangle> triangles(int body) const { return obstacle(body).trajectory->surface().triangles; }
  /// At the end of slice `slice`; -1: at the frame's start.
  std::span<const Vec3> places(int body, int slice) const {
    const Body& b = bodies_[at(body)];
    return b.places[b.moves ? at(slice + 1) : 0];
  }
  /// Box tree over the triangles at the end of a slice.
  const TriangleTree& tree(int body, int slice) const {
    const Body& b = bodies_[at(body)];
    return b.trees[b.moves ? at(slice + 1) : 0];
  }
  /// The farthest that a vertex goes in a slice [m].
  double way(int body, int slice) const { return bodies_[at(body)].moves ? bodies_[at(body)].way[at(slice)] : 0; }
  /// Of everything that the body does in the frame.
  const Box& box(int body) const { return bodies_[at(body)].box; }

  struct Side {
    std::array<int, 2> triangles{-1, -1};  ///< that an edge belongs to; the second -1 where there is none
    Edge edge{};
  };
  std::span<const Side> edges(int body) const { return bodies_[at(body)].edges; }
  /// The three edges of a triangle, into edges().
  const std::array<int, 3>& edges_of(int body, int triangle) const { return bodies_[at(body)].edges_of[at(triangle)]; }

 private:
  struct Body {
    bool sampled = false, moves = false, closed = false;
    std::array<std::vector<Vec3>, k_slices + 1> places;
    std::array<TriangleTree, k_slices + 1> trees;
    std::array<double, k_slices> way{};
    Box box;
    std::vector<Side> edges;
    std::vector<std::array<int, 3>> edges_of;
  };
  std::span<const LeafObstacle> obstacles_;
  std::vector<Body> bodies_;
};

}  // namespace ft::inline solvers
