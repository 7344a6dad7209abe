// A box tree over the triangles of one surface, for crossings, penetration depths and the feasible collider. Built once
// by median splits, refitted to new positions by one backward loop (children have larger indices than parents). Boxes
// are single precision rounded outwards, so nothing is lost; decisions are made on the double positions. The candidate
// pairs of the solver are not found here but with FCL's trees (pair_finder.h).
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "baker/core/give_back.h"
#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft::inline collision {

struct TreeBox {
  float lo[3], hi[3];
  bool overlaps(const TreeBox& b) const {
    return lo[0] <= b.hi[0] && b.lo[0] <= hi[0] && lo[1] <= b.hi[1] && b.lo[1] <= hi[1] && lo[2] <= b.hi[2] &&
           b.lo[2] <= hi[2];
  }
  /// The same with this box grown by r on every side.
  bool overlaps(const TreeBox& b, double r) const {
    for (int k = 0; k < 3; ++k)
      if (lo[k] > b.hi[k] + r || b.lo[k] > hi[k] + r) return false;
    return true;
  }
  /// Squared distance from p to the box, 0 inside [m2].
  double squared_distance(const Vec3& p) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const double below = lo[k] - p[k], above = p[k] - hi[k];
      const double d = below > above ? below : above;
      if (d > 0) sum += d * d;
    }
    return sum;
  }
  static TreeBox around(const Vec3& lo, const Vec3& hi);
};

/// Closest point of a triangle and the feature that it lies on.
struct ClosestOnTriangle {
  Vec3 point = Vec3::Zero();
  double squared_distance = std::numeric_limits<double>::infinity();  ///< m2
  int feature = 6;  ///< 0, 1, 2: corner; 3, 4, 5: edge 01, 12, 20; 6: the face
};
/// Ericson 2005, 5.1.5; degenerate triangles are answered as their edges or corners.
ClosestOnTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

class TriangleTree {
 public:
  struct Node {
    TreeBox box;
    int first = 0;  ///< leaf: into order(); inner: index of the right child (the left one follows its parent)
    int count = 0;  ///< triangles of a leaf, 0 for an inner node
  };

  TriangleTree() = default;
  /// Tree over triangles[i] for i in subset (all when subset is not given).
  TriangleTree(std::span<const Vec3> positions, std::span<const Triangle> triangles);
  TriangleTree(std::span<const Vec3> positions, std::span<const Triangle> triangles, std::vector<int> subset);

  bool empty() const { return order_.empty(); }
  std::span<const Node> nodes() const { return nodes_; }
  std::span<const int> order() const { return order_; }
  const TreeBox& box() const { return nodes_.front().box; }
  void refit(std::span<const Vec3> positions, std::span<const Triangle> triangles);
  /// Frees what a refit() makes anew: until then the tree may be asked for nothing but its order().
  void forget_boxes() { give_back(nodes_, next_); }

  /// Calls visit(triangle index) for the triangles of every leaf that the box overlaps.
  template <class Visit>
  void for_each_near(const TreeBox& box, Visit&& visit) const {
    for (int i = 0; i < static_cast<int>(nodes_.size());) {
      const Node& node = nodes_[static_cast<std::size_t>(i)];
      if (node.box.overlaps(box)) {
        for (int k = 0; k < node.count; ++k) visit(order_[static_cast<std::size_t>(node.first + k)]);
        ++i;
      } else {
        i = next_[static_cast<std::size_t>(i)];
      }
    }
  }
  /// A share of the search for pairs of two trees, or of one with itself: two nodes, or one against itself (b -1).
  struct PairTask {
    int a, b;
  };
  /// Shares that make up the whole, about as many as wanted or fewer; other may be this tree.
  std::vector<PairTask> pair_tasks(const TriangleTree& other, std::size_t wanted) const;
  /// Calls visit(i, j) for triangles of overlapping leaves; within one tree every unordered pair at most once, no
  /// triangle with itself.
  template <class Visit>
  void for_each_pair(const PairTask& task, const TriangleTree& other, Visit&& visit) const {
    if (task.b < 0)
      walk_own(task.a, visit);
    else
      walk(task.a, other, task.b, visit);
  }

  struct Hit {
    ClosestOnTriangle closest;
    int triangle = -1;  ///< -1: nothing within the given distance
  };
  /// Improves hit by this tree's triangles; start with hit.closest.squared_distance = the square of how far to look.
  void closest(const Vec3& p, std::span<const Vec3> positions, std::span<const Triangle> triangles, Hit& hit) const;
  /// The same for one leaf, whose box is known to be near enough.
  void closest_in_leaf(const Node& leaf, const Vec3& p, std::span<const Vec3> positions,
                       std::span<const Triangle> triangles, Hit& hit) const {
    for (int k = 0; k < leaf.count; ++k) {
      const int index = order_[static_cast<std::size_t>(leaf.first + k)];
      const Triangle& t = triangles[static_cast<std::size_t>(index)];
      const Vec3 &a = positions[static_cast<std::size_t>(t[0])], &b = positions[static_cast<std::size_t>(t[1])],
                 &c = positions[static_cast<std::size_t>(t[2])];
      const Vec3 outside = (a.cwiseMin(b).cwiseMin(c) - p).cwiseMax(p - a.cwiseMax(b).cwiseMax(c)).cwiseMax(0.0);
      if (outside.squaredNorm() * (1 - 1e-12) > hit.closest.squared_distance) continue;  // its box is farther
      improve(hit, closest_on_triangle(p, a, b, c), index);
    }
  }
  /// Takes what was found on a triangle where it is nearer; of two as near, the lower triangle.
  static void improve(Hit& hit, const ClosestOnTriangle& found, int triangle) {
    const double d2 = found.squared_distance, least = hit.closest.squared_distance;
    if (d2 < least || (d2 == least && (hit.triangle < 0 || triangle < hit.triangle))) hit = {found, triangle};
  }
  /// Distance along the unit direction to the first triangle other than skip, or length when there is none before it
  /// [m].
  double ray(const Vec3& origin, const Vec3& direction, double length, int skip, std::span<const Vec3> positions,
             std::span<const Triangle> triangles) const;

  /// Calls visit(triangle index) for the triangles of every leaf whose box the ray meets.
  template <class Visit>
  void for_each_along(const Vec3& origin, const Vec3& direction, double length, Visit&& visit) const {
    for (int i = 0; i < static_cast<int>(nodes_.size());) {
      const Node& node = nodes_[static_cast<std::size_t>(i)];
      if (meets(node.box, origin, direction, length)) {
        for (int k = 0; k < node.count; ++k) visit(order_[static_cast<std::size_t>(node.first + k)]);
        ++i;
      } else {
        i = next_[static_cast<std::size_t>(i)];
      }
    }
  }

 private:
  void refit_node(std::size_t n, std::span<const Vec3> positions, std::span<const Triangle> triangles);
  static bool meets(const TreeBox& box, const Vec3& origin, const Vec3& direction, double length);
  void arrange(std::span<const Vec3> centres, int begin, int end);
  int lay_out(int begin, int end);
  template <class Visit>
  void walk(int a, const TriangleTree& other, int b, Visit& visit) const {
    const Node& m = nodes_[static_cast<std::size_t>(a)];
    const Node& n = other.nodes_[static_cast<std::size_t>(b)];
    if (!m.box.overlaps(n.box)) return;
    if (m.count > 0 && n.count > 0) {
      for (int i = 0; i < m.count; ++i)
        for (int j = 0; j < n.count; ++j)
          visit(order_[static_cast<std::size_t>(m.first + i)], other.order_[static_cast<std::size_t>(n.first + j)]);
    } else if (descends(m, n)) {
      walk(a + 1, other, b, visit);
      walk(m.first, other, b, visit);
    } else {
      walk(a, other, b + 1, visit);
      walk(a, other, n.first, visit);
    }
  }
  template <class Visit>
  void walk_own(int a, Visit& visit) const {
    const Node& m = nodes_[static_cast<std::size_t>(a)];
    if (m.count > 0) {
      for (int i = 0; i < m.count; ++i)
        for (int j = i + 1; j < m.count; ++j)
          visit(order_[static_cast<std::size_t>(m.first + i)], order_[static_cast<std::size_t>(m.first + j)]);
      return;
    }
    walk_own(a + 1, visit);
    walk_own(m.first, visit);
    walk(a + 1, *this, m.first, visit);
  }
  /// Whether a walk goes on with m's children; else with n's.
  static bool descends(const Node& m, const Node& n) {
    return n.count > 0 || (m.count == 0 && extent(m.box) >= extent(n.box));
  }
  static float extent(const TreeBox& b) { return (b.hi[0] - b.lo[0]) + (b.hi[1] - b.lo[1]) + (b.hi[2] - b.lo[2]); }

  std::vector<Node> nodes_;
  std::vector<int> next_;  ///< node to visit when a node's subtree is skipped
  std::vector<int> order_;
};

}  // namespace ft::inline collision
