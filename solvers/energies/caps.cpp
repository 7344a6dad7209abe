#include "solvers/energies/caps.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ft::inline solvers {
namespace {

/// Height of the highest cap in its longest edges, and in its shortest.
constexpr double k_cap_height = 0.02, k_cap_shortest = 1.0 / 3;
/// What the two of them may gain or lose of their area [1]: more where they are folded over each other at rest.
constexpr double k_same_area = 0.05;
/// The other diagonal must be no shorter than this share of the cap's base: else it would be a needle's end [1].
constexpr double k_least_diagonal = 0.1;
/// Two corners have the same pattern coordinates, in lengths of the edge.
constexpr double k_same_uv = 1e-6;

Edge edge_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

class Flips {
 public:
  Flips(ClothTopology& topology, std::vector<std::array<Vec2, 3>>& uvs, const std::function<void(std::size_t)>& measure)
      : topology_(topology), uvs_(uvs), measure_(measure) {
    for (std::size_t t = 0; t < topology.triangles.size(); ++t) remember(t);
  }

  void flip(std::size_t cap) {
    const Corners c = corners(cap);
    std::size_t top = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (rest_length(topology_, cap, k) > rest_length(topology_, cap, top)) top = k;
    const std::size_t a = (top + 1) % 3, b = (top + 2) % 3;
    const Edge base = edge_of(c.vertex[a], c.vertex[b]);
    const std::vector<std::size_t> users = around_.at(base);
    if (users.size() != 2) return;
    const std::size_t other = users[users[0] == cap ? 1 : 0];
    const Corners o = corners(other);
    std::size_t far = 0;  // the corner of the other that looks at the base, which it has the other way round
    while (far < 3 && (o.vertex[(far + 1) % 3] != c.vertex[b] || o.vertex[(far + 2) % 3] != c.vertex[a])) ++far;
    if (far == 3 || around_.contains(edge_of(c.vertex[top], o.vertex[far]))) return;
    const double length = rest_length(topology_, cap, top);
    const auto differ = [&](const Vec2& p, const Vec2& q) {
      return !((p - q).norm() <= k_same_uv * (c.uv[b] - c.uv[a]).norm());
    };
    if (differ(c.uv[a], o.uv[(far + 2) % 3]) || differ(c.uv[b], o.uv[(far + 1) % 3])) return;
    const double area = area_of(cap, other);
    forget(cap), forget(other);
    set(cap, {{c.vertex[a], o.vertex[far], c.vertex[top]}, {c.uv[a], o.uv[far], c.uv[top]}});
    set(other, {{o.vertex[far], c.vertex[b], c.vertex[top]}, {o.uv[far], c.uv[b], c.uv[top]}});
    if (is_sound(cap) && is_sound(other) && std::abs(area_of(cap, other) - area) < k_same_area * area &&
        rest_length(topology_, cap, 0) > k_least_diagonal * length) {
      topology_.flipped_caps.push_back({c.vertex[top], base, length});
      return;
    }
    forget(cap), forget(other);
    set(cap, c), set(other, o);
  }

 private:
  struct Corners {
    Triangle vertex;
    std::array<Vec2, 3> uv;
  };

  Corners corners(std::size_t t) const {
    const Vec2 none = Vec2::Zero();
    return {topology_.triangles[t], uvs_.empty() ? std::array<Vec2, 3>{none, none, none} : uvs_[t]};
  }
  void set(std::size_t t, const Corners& c) {
    topology_.triangles[t] = c.vertex;
    if (!uvs_.empty()) uvs_[t] = c.uv;
    remember(t);
    measure_(t);
  }
  void remember(std::size_t t) {
    const Triangle& v = topology_.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) around_[edge_of(v[k], v[(k + 1) % 3])].push_back(t);
  }
  void forget(std::size_t t) {
    const Triangle& v = topology_.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = around_.find(edge_of(v[k], v[(k + 1) % 3]));
      std::erase(found->second, t);
      if (found->second.empty()) around_.erase(found);
    }
  }
  bool is_sound(std::size_t t) const {
    return topology_.rest_area[t] > 0 && cap_stiffness(topology_.rest_area[t], topology_.rest_inverse[t]) == 1;
  }
  double area_of(std::size_t t, std::size_t u) const { return topology_.rest_area[t] + topology_.rest_area[u]; }

  ClothTopology& topology_;
  std::vector<std::array<Vec2, 3>>& uvs_;
  const std::function<void(std::size_t)>& measure_;
  std::map<Edge, std::vector<std::size_t>> around_;  ///< triangles of each edge
};

}  // namespace

double cap_stiffness(double rest_area, const std::array<double, 4>& rest_inverse) {
  // Rest edges in material axes: columns of the inverse of rest_inverse.
  const auto& r = rest_inverse;
  const double det = r[0] * r[3] - r[1] * r[2];
  const Vec2 first = Vec2(r[3], -r[2]) / det, second = Vec2(-r[1], r[0]) / det;
  const auto [shortest, longest] = std::minmax({first.norm(), second.norm(), (second - first).norm()});
  const double height = 2 * rest_area / longest;
  const double share = height < k_cap_shortest * shortest ? height / (k_cap_height * longest) : 1;
  return share < 1 ? share * share : 1;
}

void flip_caps(ClothTopology& topology, std::vector<std::array<Vec2, 3>>& uvs,
               const std::function<void(std::size_t)>& measure) {
  std::vector<std::size_t> caps;
  const auto is_cap = [&](std::size_t t) {
    return topology.rest_area[t] > 0 && cap_stiffness(topology.rest_area[t], topology.rest_inverse[t]) < 1;
  };
  for (std::size_t t = 0; t < topology.triangles.size(); ++t)
    if (is_cap(t)) caps.push_back(t);
  if (caps.empty()) return;
  Flips flips(topology, uvs, measure);
  for (const std::size_t t : caps)
    if (is_cap(t)) flips.flip(t);  // else it was the other one of another
}

}  // namespace ft::inline solvers
