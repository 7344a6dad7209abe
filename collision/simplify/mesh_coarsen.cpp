#include "collision/simplify/mesh_coarsen.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "baker/core/check.h"
#include "collision/geometry/pair_geometry.h"

namespace ft::inline collision {
namespace {

constexpr double k_short = 0.8;  ///< of the wanted length: shorter edges are collapsed [1]
constexpr double k_long = 1.4;   ///< of the wanted length: no collapse makes a longer edge [1]
/// Of a triangle after a collapse, 1 is equilateral [1]; what is worse may not get worse.
constexpr double k_least_shape = 0.3;
constexpr double k_turn = 0.7;       ///< cosine of the most that a triangle turns in a collapse
constexpr double k_straight = -0.8;  ///< cosine between an outline's edges up to which it is no corner

/// Whether a triangle may become another in a collapse.
bool keeps_shape(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q) {
  const Vec3 m = (p[1] - p[0]).cross(p[2] - p[0]), n = (q[1] - q[0]).cross(q[2] - q[0]);
  if (m.dot(n) < k_turn * m.norm() * n.norm() || !(n.norm() > 0)) return false;
  return shape_of(q[0], q[1], q[2]) >= std::min(k_least_shape, shape_of(p[0], p[1], p[2]));
}

bool has(const Triangle& t, int v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

class Coarsener : public CollapsingMesh {
 public:
  explicit Coarsener(const CoarsenInput& in);
  bool round();

 private:
  struct Collapse {
    double length;  ///< of the edge, in wanted lengths
    int a, b;
    auto operator<=>(const Collapse&) const = default;
  };

  double wanted(int a, int b) const { return std::min(0.5 * in_.factor * (size_[at(a)] + size_[at(b)]), in_.longest); }
  std::optional<Vec2> uv_at(int a, std::span<const int> triangles) const;
  bool keeps_pattern(int t, int b, const Vec2& uv) const;
  bool may(int b, int a) const;
  double deviation(int b, int a) const;
  void hold_branches();
  void hold_seams();

  const CoarsenInput& in_;
  std::vector<int> group_;
  std::vector<double> deviation_;  ///< sum of the distances that CoarsenInput::deviation limits [m]
  std::vector<double> size_;       ///< mean length of the edges around a vertex at the start [m]
  std::vector<char> fresh_;        ///< per vertex: what is around it is not as it was before the last round
};

Coarsener::Coarsener(const CoarsenInput& in)
    : CollapsingMesh(in.rest, in.triangles, in.uvs),
      in_(in),
      group_(in.group.begin(), in.group.end()),
      deviation_(in.rest.size(), 0.0),
      size_(in.rest.size(), 0.0),
      fresh_(in.rest.size(), 1) {
  CHECK(!uvs_.empty() || !in.cut || triangles_.empty());
  CHECK(group_.empty() || group_.size() == in.rest.size());
  group_.resize(in.rest.size(), 0);
  std::vector<int> count(in.rest.size(), 0);
  for (const Edge& e : unique_edges(triangles_))
    for (const int v : e) {
      size_[at(v)] += (in.rest[at(e[0])] - in.rest[at(e[1])]).norm();
      ++count[at(v)];
    }
  for (std::size_t v = 0; v < size_.size(); ++v)
    if (count[v] > 0) size_[v] /= count[v];
  hold_branches();
  hold_seams();
}

/// Where more than two triangles meet at an edge, or sheets touch in a point, and at degenerate triangles.
void Coarsener::hold_branches() {
  for (std::size_t v = 0; v < around_.size(); ++v) {
    const bool degenerate = std::any_of(around_[v].begin(), around_[v].end(), [&](int t) {
      const Triangle& c = triangles_[at(t)];
      return shape_of(rest_[at(c[0])], rest_[at(c[1])], rest_[at(c[2])]) < 1e-6;
    });
    if (degenerate || branches(static_cast<int>(v))) group_[v] = k_group_stays;
  }
}

void Coarsener::hold_seams() {
  if (uvs_.empty()) return;
  std::vector<Vec2> first(in_.rest.size());
  std::vector<char> known(in_.rest.size(), 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = at(triangles_[t][k]);
      if (known[v] && first[v] != uvs_[t][k]) group_[v] = k_group_stays;
      first[v] = uvs_[t][k];
      known[v] = 1;
    }
}

/// Of vertex a in these triangles around it; none where they differ, as at the end of a slit in the pattern.
std::optional<Vec2> Coarsener::uv_at(int a, std::span<const int> triangles) const {
  if (uvs_.empty()) return Vec2::Zero();
  const Vec2 uv = uvs_[at(triangles[0])][corner(triangles[0], a)];
  for (const int t : triangles)
    if (uvs_[at(t)][corner(t, a)] != uv) return {};
  return uv;
}

/// Whether triangle t keeps its shape in the plane of the uvs when its vertex b goes to `uv`.
bool Coarsener::keeps_pattern(int t, int b, const Vec2& uv) const {
  std::array<Vec3, 3> p, q;
  for (std::size_t k = 0; k < 3; ++k) p[k] = q[k] = Vec3(uvs_[at(t)][k].x(), uvs_[at(t)][k].y(), 0);
  q[corner(t, b)] = Vec3(uv.x(), uv.y(), 0);
  return keeps_shape(p, q);
}

/// Whether b may be drawn into its neighbour a.
bool Coarsener::may(int b, int a) const {
  const auto& x = in_.rest;
  const int group = group_[at(b)];
  if (group == k_group_stays || (group != 0 && group != group_[at(a)])) return false;
  const std::vector<int> gone = shared(a, b);
  if (!keeps_topology(b, a, gone)) return false;
  const std::vector<int> of_b = neighbours(b);
  if (on_outline(b)) {
    for (const int w : of_b) {
      if (w == a || shared(b, w).size() != 1) continue;
      const Vec3 u = x[at(a)] - x[at(b)], v = x[at(w)] - x[at(b)];
      if (u.dot(v) > k_straight * u.norm() * v.norm()) return false;
    }
  }
  const std::optional<Vec2> uv = uv_at(a, gone);
  if (!uv) return false;
  for (const int w : of_b)
    if (w != a && (x[at(w)] - x[at(a)]).norm() > k_long * wanted(a, w)) return false;
  bool some_left = false;
  for (const int t : around_[at(b)]) {
    const Triangle& old = triangles_[at(t)];
    if (has(old, a)) continue;
    some_left = true;
    std::array<Vec3, 3> p{x[at(old[0])], x[at(old[1])], x[at(old[2])]}, q = p;
    q[corner(t, b)] = x[at(a)];
    if (!keeps_shape(p, q) || (in_.cut && !keeps_pattern(t, b, *uv))) return false;
  }
  return some_left && deviation(b, a) <= in_.deviation;
}

/// How far off the surface b, and what was drawn into it, lies when it is drawn into a [m].
double Coarsener::deviation(int b, int a) const {
  if (std::isinf(in_.deviation)) return 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const int t : around_[at(b)]) {
    Triangle c = triangles_[at(t)];
    if (has(c, a)) continue;
    std::replace(c.begin(), c.end(), b, a);
    const auto& x = in_.rest;
    nearest = std::min(nearest, vertex_face_geometry(x[at(b)], x[at(c[0])], x[at(c[1])], x[at(c[2])]).distance);
  }
  return deviation_[at(b)] + nearest;
}

/// Collapses edges that do not touch each other; false when there was none to collapse. An edge that could not be
/// collapsed still cannot where nothing around its ends has changed.
bool Coarsener::round() {
  std::vector<Triangle> alive;
  for (const Triangle& t : triangles_)
    if (t[0] >= 0) alive.push_back(t);
  std::vector<Collapse> collapses;
  for (const Edge& e : unique_edges(alive)) {
    const double length = (in_.rest[at(e[0])] - in_.rest[at(e[1])]).norm() / wanted(e[0], e[1]);
    if (length < k_short && (fresh_[at(e[0])] | fresh_[at(e[1])]) != 0) collapses.push_back({length, e[0], e[1]});
  }
  std::sort(collapses.begin(), collapses.end());
  std::vector<char> touched(in_.rest.size(), 0);
  bool any = false;
  for (const Collapse& c : collapses) {
    if (touched[at(c.a)] || touched[at(c.b)]) continue;
    const bool second = may(c.b, c.a);
    if (!second && !may(c.a, c.b)) continue;
    const int from = second ? c.b : c.a, to = second ? c.a : c.b;
    for (const int v : {from, to})
      for (const int w : neighbours(v)) touched[at(w)] = 1;
    deviation_[at(to)] = std::max(deviation_[at(to)], deviation(from, to));
    draw(from, to);
    any = true;
  }
  fresh_.swap(touched);
  return any;
}

}  // namespace

CoarsenedMesh coarsen_mesh(const CoarsenInput& input) {
  Coarsener mesh(input);
  while (mesh.round()) {
  }
  return mesh.result();
}

}  // namespace ft::inline collision
