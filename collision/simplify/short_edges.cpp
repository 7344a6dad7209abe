#include "collision/simplify/short_edges.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"

namespace ft::inline collision {
namespace {

constexpr double k_turn = 0.5;  ///< cosine of the most that a triangle turns in a collapse
/// A collapse leaves triangles at least this good (shape_of), or so much of what they were [1].
constexpr double k_least_shape = 0.2, k_share_of_shape = 0.7;
/// Of two ways whose worst triangles differ by less than this factor, the number of triangles decides [1].
constexpr double k_as_good = 1.1;
/// Triangles whose edges are no longer than this many times the shortest will go or matter to nobody [1].
constexpr double k_small = 3;
/// A triangle that is lower than this share of its longest edge does not know which way it faces [1].
constexpr double k_flat = 0.01;

struct Corners {
  Vec3 a, b, c;
  Vec3 normal() const { return (b - a).cross(c - a); }
  double longest() const { return std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()}); }
  double shape() const { return shape_of(a, b, c); }
};

bool has(const Triangle& t, int v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

class ShortEdges : public CollapsingMesh {
 public:
  explicit ShortEdges(const ShortEdgesInput& in) : CollapsingMesh(in.rest, in.triangles, in.uvs), in_(in) {
    CHECK(in.held.empty() || in.held.size() == in.rest.size());
    CHECK(!uvs_.empty() || !(in.pattern_scale > 0) || triangles_.empty());
  }
  bool round();

 private:
  struct Collapse {
    double length;  ///< m
    int a, b;
    auto operator<=>(const Collapse&) const = default;
  };
  struct Worth {
    bool keeps_held;
    double worst;           ///< shape of the worst triangle
    std::size_t triangles;  ///< of what is drawn
    /// What a cut has put on an edge has few triangles: without it the mesh is what it was, and where that folds, the
    /// vertex is on the edge.
    bool operator>=(const Worth& other) const {
      if (keeps_held != other.keeps_held) return keeps_held;
      if (worst > k_as_good * other.worst || other.worst > k_as_good * worst) return worst > other.worst;
      return triangles != other.triangles ? triangles < other.triangles : worst >= other.worst;
    }
  };
  std::vector<Collapse> short_edges() const;
  std::optional<Worth> worth(int b, int a) const;
  bool leaves_all_something(int b, int a, std::span<const int> gone) const;
  bool short_in_pattern(int b, int a, std::span<const int> gone) const;
  bool keeps_faces(int b, int a, std::span<const int> gone, double& worst) const;
  Corners in_space(const Triangle& t) const { return {rest_[at(t[0])], rest_[at(t[1])], rest_[at(t[2])]}; }
  Corners in_pattern(const std::array<Vec2, 3>& uv) const;

  const ShortEdgesInput& in_;
};

std::vector<ShortEdges::Collapse> ShortEdges::short_edges() const {
  std::vector<Collapse> out;
  for (const Triangle& t : triangles_) {
    if (t[0] < 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      const double length = (rest_[at(a)] - rest_[at(b)]).norm();
      if (length < in_.shortest) out.push_back({length, a, b});
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Corners ShortEdges::in_pattern(const std::array<Vec2, 3>& uv) const {
  const auto point = [&](const Vec2& p) { return Vec3(in_.pattern_scale * p.x(), in_.pattern_scale * p.y(), 0); };
  return {point(uv[0]), point(uv[1]), point(uv[2])};
}

/// No vertex that stays loses its last triangle, and no piece of the mesh goes.
bool ShortEdges::leaves_all_something(int b, int a, std::span<const int> gone) const {
  const auto gone_of = [&](int v) {
    return std::count_if(gone.begin(), gone.end(), [&](int t) { return has(triangles_[at(t)], v); });
  };
  if (around_[at(a)].size() + around_[at(b)].size() == 2 * gone.size()) return false;
  for (const int t : gone)
    for (const int v : triangles_[at(t)])
      if (v != a && v != b && static_cast<std::ptrdiff_t>(around_[at(v)].size()) == gone_of(v)) return false;
  return true;
}

bool ShortEdges::short_in_pattern(int b, int a, std::span<const int> gone) const {
  return std::all_of(gone.begin(), gone.end(), [&](int t) {
    const auto& uv = uvs_[at(t)];
    return in_.pattern_scale * (uv[corner(t, a)] - uv[corner(t, b)]).norm() < in_.shortest;
  });
}

/// Whether triangles around b face where they did and stay as good as they have to be; `worst`: shape of the worst.
bool ShortEdges::keeps_faces(int b, int a, std::span<const int> gone, double& worst) const {
  const bool cut = in_.pattern_scale > 0;
  Vec3 facing = Vec3::Zero();  // of all that meets there
  for (const int v : {a, b})
    for (const int t : around_[at(v)]) facing += in_space(triangles_[at(t)]).normal();
  const auto keeps = [&](const Corners& p, const Corners& q, bool knows_facing) {
    const Vec3 before = p.normal(), after = q.normal();
    const double longest = p.longest();
    const Vec3 side = knows_facing && before.norm() < k_flat * longest * longest ? facing : before;
    if (!(after.norm() > 0) || side.dot(after) < k_turn * side.norm() * after.norm()) return false;
    worst = std::min(worst, q.shape());
    return longest < k_small * in_.shortest || q.shape() >= std::min(k_least_shape, k_share_of_shape * p.shape());
  };
  for (const int t : around_[at(b)]) {
    const Triangle& old = triangles_[at(t)];
    if (has(old, a)) continue;
    Triangle now = old;
    now[corner(t, b)] = a;
    for (const int other : around_[at(a)]) {  // it would lie on another, as in a tetrahedron
      Triangle x = now, y = triangles_[at(other)];
      std::sort(x.begin(), x.end());
      std::sort(y.begin(), y.end());
      if (x == y) return false;
    }
    if (!keeps(in_space(old), in_space(now), true)) return false;
    if (!cut) continue;
    std::array<Vec2, 3> uv = uvs_[at(t)];
    const std::optional<Vec2> there = uv_after(uv[corner(t, b)], b, a, gone);
    if (!there) return false;
    uv[corner(t, b)] = *there;
    if (!keeps(in_pattern(uvs_[at(t)]), in_pattern(uv), false)) return false;
  }
  return true;
}

/// How well b may be drawn into its neighbour a; none: it may not be.
std::optional<ShortEdges::Worth> ShortEdges::worth(int b, int a) const {
  const std::vector<int> gone = shared(a, b);
  if (branches(b) || !keeps_topology(b, a, gone) || !leaves_all_something(b, a, gone)) return {};
  if (in_.pattern_scale > 0 && !short_in_pattern(b, a, gone)) return {};
  double worst = 1;
  if (!keeps_faces(b, a, gone, worst)) return {};
  const bool lost = !in_.held.empty() && in_.held[at(b)] > in_.held[at(a)];
  return Worth{!lost, worst, around_[at(b)].size()};
}

/// Collapses edges that do not touch each other; false when there was none to collapse.
bool ShortEdges::round() {
  std::vector<char> touched(rest_.size(), 0);
  bool any = false;
  for (const Collapse& c : short_edges()) {
    if (touched[at(c.a)] || touched[at(c.b)]) continue;
    const std::optional<Worth> into_a = worth(c.b, c.a), into_b = worth(c.a, c.b);
    if (!into_a && !into_b) continue;
    const bool to_a = into_a && (!into_b || *into_a >= *into_b);
    const int from = to_a ? c.b : c.a, to = to_a ? c.a : c.b;
    for (const int v : {from, to})
      for (const int w : neighbours(v)) touched[at(w)] = 1;
    draw(from, to);
    any = true;
  }
  return any;
}

}  // namespace

bool has_short_edges(const ShortEdgesInput& in) {
  return std::any_of(in.triangles.begin(), in.triangles.end(), [&](const Triangle& t) {
    for (std::size_t k = 0; k < 3; ++k)
      if ((in.rest[at(t[k])] - in.rest[at(t[(k + 1) % 3])]).norm() < in.shortest) return true;
    return false;
  });
}

CoarsenedMesh collapse_short_edges(const ShortEdgesInput& input) {
  ShortEdges mesh(input);
  while (mesh.round()) {
  }
  return mesh.result();
}

}  // namespace ft::inline collision
