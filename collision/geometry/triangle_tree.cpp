// See triangle_tree.h. Median splits along the longest side of the centres' box; leaves of up to four triangles.
#include "collision/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "baker/core/parallel.h"

namespace ft::inline collision {
namespace {

constexpr int k_leaf_size = 4;
constexpr std::size_t k_limb = 512;  ///< most nodes that are refitted as one
constexpr double k_sliver = 1e-12;   ///< squared sine of an angle below which a triangle is answered as its edges
/// Of a triangle's size: a ray may pass beside it by so much and hits it still, so that none slips through between two
/// [1].
constexpr double k_edge = 1e-9;

int middle_of(int begin, int end) {
  return begin + (end - begin) / 2;
}

/// Of a tree of so many triangles.
std::size_t node_count(std::size_t triangles) {
  if (triangles <= k_leaf_size) return 1;
  return 1 + node_count(triangles / 2) + node_count(triangles - triangles / 2);
}

float round_down(double v) {
  const auto f = static_cast<float>(v);
  return f - std::abs(f) * 1.2e-7f - std::numeric_limits<float>::min();
}
float round_up(double v) {
  const auto f = static_cast<float>(v);
  return f + std::abs(f) * 1.2e-7f + std::numeric_limits<float>::min();
}

ClosestOnTriangle closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b, int corner_a, int corner_b,
                                     int edge) {
  const Vec3 d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0 ? (p - a).dot(d) / length2 : 0.0;
  ClosestOnTriangle out;
  if (!(t > 0)) {
    out.point = a, out.feature = corner_a;
  } else if (t >= 1) {
    out.point = b, out.feature = corner_b;
  } else {
    out.point = a + t * d, out.feature = edge;
  }
  out.squared_distance = (p - out.point).squaredNorm();
  return out;
}

}  // namespace

TreeBox TreeBox::around(const Vec3& lo, const Vec3& hi) {
  return {{round_down(lo.x()), round_down(lo.y()), round_down(lo.z())},
          {round_up(hi.x()), round_up(hi.y()), round_up(hi.z())}};
}

ClosestOnTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const auto answer = [&](const Vec3& q, int feature) { return ClosestOnTriangle{q, (p - q).squaredNorm(), feature}; };
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return answer(a, 0);
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return answer(b, 1);
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return answer(c, 2);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  const double sum = va + vb + vc;  // twice the area, squared
  if (sum > k_sliver * ab.squaredNorm() * ac.squaredNorm()) {
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return answer(a + ab * (d1 / (d1 - d3)), 3);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return answer(a + ac * (d2 / (d2 - d6)), 5);
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return answer(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), 4);
    if (va > 0 && vb > 0 && vc > 0) return answer(a + ab * (vb / sum) + ac * (vc / sum), 6);
  }
  // A sliver, whose regions rounding would mix up: the nearest of the three edges.
  ClosestOnTriangle best = closest_on_segment(p, a, b, 0, 1, 3);
  for (const ClosestOnTriangle& other : {closest_on_segment(p, b, c, 1, 2, 4), closest_on_segment(p, c, a, 2, 0, 5)})
    if (other.squared_distance < best.squared_distance) best = other;
  return best;
}

TriangleTree::TriangleTree(std::span<const Vec3> positions, std::span<const Triangle> triangles)
    : TriangleTree(positions, triangles, [&] {
        std::vector<int> all(triangles.size());
        std::iota(all.begin(), all.end(), 0);
        return all;
      }()) {}

TriangleTree::TriangleTree(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                           std::vector<int> subset)
    : order_(std::move(subset)) {
  if (order_.empty()) return;
  std::vector<Vec3> centres(triangles.size());
  for (const int i : order_) {
    const Triangle& t = triangles[static_cast<std::size_t>(i)];
    centres[static_cast<std::size_t>(i)] = positions[static_cast<std::size_t>(t[0])] +
                                           positions[static_cast<std::size_t>(t[1])] +
                                           positions[static_cast<std::size_t>(t[2])];
  }
  arrange(centres, 0, static_cast<int>(order_.size()));
  refit(positions, triangles);
}

std::vector<TriangleTree::PairTask> TriangleTree::pair_tasks(const TriangleTree& other, std::size_t wanted) const {
  std::vector<PairTask> tasks, next;
  if (empty() || other.empty()) return tasks;
  tasks.push_back({0, &other == this ? -1 : 0});
  for (bool more = true; more && tasks.size() < wanted; tasks.swap(next)) {
    more = false;
    next.clear();
    for (const PairTask& task : tasks) {
      const Node& m = nodes_[static_cast<std::size_t>(task.a)];
      if (task.b < 0) {
        if (m.count > 0) {
          next.push_back(task);
          continue;
        }
        next.insert(next.end(), {{task.a + 1, -1}, {m.first, -1}, {task.a + 1, m.first}});
      } else {
        const Node& n = other.nodes_[static_cast<std::size_t>(task.b)];
        if (!m.box.overlaps(n.box)) continue;
        if (m.count > 0 && n.count > 0) {
          next.push_back(task);
          continue;
        }
        if (descends(m, n))
          next.insert(next.end(), {{task.a + 1, task.b}, {m.first, task.b}});
        else
          next.insert(next.end(), {{task.a, task.b + 1}, {task.a, n.first}});
      }
      more = true;
    }
  }
  return tasks;
}

/// Sorts the order of triangles by the halves that lay_out() makes nodes of.
void TriangleTree::arrange(std::span<const Vec3> centres, int begin, int end) {
  if (end - begin <= k_leaf_size) return;
  Box box;
  for (int i = begin; i < end; ++i) box.include(centres[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])]);
  int axis = 0;
  (box.hi - box.lo).maxCoeff(&axis);
  const int middle = middle_of(begin, end);
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int i, int j) {
    const double u = centres[static_cast<std::size_t>(i)][axis], v = centres[static_cast<std::size_t>(j)][axis];
    return u < v || (u == v && i < j);
  });
  arrange(centres, begin, middle);
  arrange(centres, middle, end);
}

/// Nodes follow from how many triangles there are alone.
int TriangleTree::lay_out(int begin, int end) {
  const auto self = nodes_.size();
  nodes_.push_back({});
  next_.push_back(0);
  if (end - begin <= k_leaf_size) {
    nodes_[self].first = begin, nodes_[self].count = end - begin;
  } else {
    const int middle = middle_of(begin, end);
    lay_out(begin, middle);
    const int right = lay_out(middle, end);
    nodes_[self].first = right;
  }
  next_[self] = static_cast<int>(nodes_.size());
  return static_cast<int>(self);
}

void TriangleTree::refit(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  if (nodes_.empty() && !order_.empty()) {
    const std::size_t count = node_count(order_.size());
    nodes_.reserve(count);
    next_.reserve(count);
    lay_out(0, static_cast<int>(order_.size()));
  }
  // Children lie behind their parents, and what is below a node side by side: limbs, and the trunk that bears them.
  std::vector<std::size_t> trunk, limbs;
  for (std::size_t n = 0; n < nodes_.size();) {
    const auto end = static_cast<std::size_t>(next_[n]);
    const bool limb = end - n <= k_limb;
    (limb ? limbs : trunk).push_back(n);
    n = limb ? end : n + 1;
  }
  parallel_tasks(limbs.size(), [&](std::size_t i) {
    for (auto n = static_cast<std::size_t>(next_[limbs[i]]); n-- > limbs[i];) refit_node(n, positions, triangles);
  });
  for (std::size_t i = trunk.size(); i-- > 0;) refit_node(trunk[i], positions, triangles);
}

void TriangleTree::refit_node(std::size_t n, std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  Node& node = nodes_[n];
  if (node.count > 0) {
    Box box;
    for (int k = 0; k < node.count; ++k)
      for (const int v : triangles[static_cast<std::size_t>(order_[static_cast<std::size_t>(node.first + k)])])
        box.include(positions[static_cast<std::size_t>(v)]);
    node.box = TreeBox::around(box.lo, box.hi);
  } else {
    const TreeBox &left = nodes_[n + 1].box, &right = nodes_[static_cast<std::size_t>(node.first)].box;
    for (int k = 0; k < 3; ++k) {
      node.box.lo[k] = std::min(left.lo[k], right.lo[k]);
      node.box.hi[k] = std::max(left.hi[k], right.hi[k]);
    }
  }
}

bool TriangleTree::meets(const TreeBox& box, const Vec3& origin, const Vec3& direction, double length) {
  double begin = 0, end = length;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0) {
      if (origin[k] < box.lo[k] || origin[k] > box.hi[k]) return false;
      continue;
    }
    const double u = (box.lo[k] - origin[k]) / direction[k], v = (box.hi[k] - origin[k]) / direction[k];
    begin = std::max(begin, std::min(u, v));
    end = std::min(end, std::max(u, v));
  }
  return begin <= end * (1 + 1e-12) + 1e-12;
}

double TriangleTree::ray(const Vec3& origin, const Vec3& direction, double length, int skip,
                         std::span<const Vec3> positions, std::span<const Triangle> triangles) const {
  double nearest = length;
  for_each_along(origin, direction, length, [&](int i) {
    if (i == skip) return;
    const Triangle& t = triangles[static_cast<std::size_t>(i)];
    const Vec3& a = positions[static_cast<std::size_t>(t[0])];
    const Vec3 e = positions[static_cast<std::size_t>(t[1])] - a, f = positions[static_cast<std::size_t>(t[2])] - a;
    const Vec3 h = direction.cross(f);
    const double determinant = e.dot(h);
    if (determinant == 0) return;
    const Vec3 s = origin - a;
    const double u = s.dot(h) / determinant;
    const Vec3 q = s.cross(e);
    const double v = direction.dot(q) / determinant;
    if (u < -k_edge || v < -k_edge || u + v > 1 + k_edge) return;
    const double along = f.dot(q) / determinant;
    if (along > 0 && along < nearest) nearest = along;
  });
  return nearest;
}

void TriangleTree::closest(const Vec3& p, std::span<const Vec3> positions, std::span<const Triangle> triangles,
                           Hit& hit) const {
  if (empty()) return;
  struct Entry {
    int node;
    double distance2;
  };
  Entry stack[96];
  int top = 0;
  stack[top++] = {0, nodes_[0].box.squared_distance(p)};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.distance2 > hit.closest.squared_distance) continue;
    const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
    if (node.count > 0) {
      closest_in_leaf(node, p, positions, triangles, hit);
      continue;
    }
    Entry left{entry.node + 1, nodes_[static_cast<std::size_t>(entry.node) + 1].box.squared_distance(p)};
    Entry right{node.first, nodes_[static_cast<std::size_t>(node.first)].box.squared_distance(p)};
    if (left.distance2 < right.distance2) std::swap(left, right);
    stack[top++] = left;
    stack[top++] = right;
  }
}

}  // namespace ft::inline collision
