#include "collision/mesh_coarsen.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "baker/core/check.h"
#include "collision/pair_geometry.h"

namespace ft {
namespace {

constexpr double k_short = 0.8;  ///< of the wanted length: shorter edges are collapsed [1]
constexpr double k_long = 1.4;   ///< of the wanted length: no collapse makes a longer edge [1]
/// Of a triangle after a collapse, 1 is equilateral [1]; what is worse may not get worse.
constexpr double k_least_shape = 0.3;
constexpr double k_turn = 0.7;       ///< cosine of the most that a triangle turns in a collapse
constexpr double k_straight = -0.8;  ///< cosine between an outline's edges up to which it is no corner

/// 4 sqrt(3) area / sum of squared edges [1].
double shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double sum = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return sum > 0 ? 4 * std::sqrt(3.0) * triangle_area(a, b, c) / sum : 0;
}

/// Whether a triangle may become another in a collapse.
bool keeps_shape(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q) {
  const Vec3 m = (p[1] - p[0]).cross(p[2] - p[0]), n = (q[1] - q[0]).cross(q[2] - q[0]);
  if (m.dot(n) < k_turn * m.norm() * n.norm() || !(n.norm() > 0)) return false;
  return shape_of(q[0], q[1], q[2]) >= std::min(k_least_shape, shape_of(p[0], p[1], p[2]));
}

bool has(const Triangle& t, int v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

class Coarsener {
 public:
  explicit Coarsener(const CoarsenInput& in);
  bool round();
  CoarsenedMesh result() const;

 private:
  struct Collapse {
    double length;  ///< of the edge, in wanted lengths
    int a, b;
    auto operator<=>(const Collapse&) const = default;
  };

  double wanted(int a, int b) const { return std::min(0.5 * in_.factor * (size_[at(a)] + size_[at(b)]), in_.longest); }
  std::vector<int> neighbours(int v) const;
  std::vector<int> shared(int a, int b) const;
  bool on_outline(int v) const;
  std::size_t corner(int t, int v) const;
  std::optional<Vec2> uv_at(int a, std::span<const int> triangles) const;
  bool keeps_pattern(int t, int b, const Vec2& uv) const;
  bool may(int b, int a) const;
  double deviation(int b, int a) const;
  void draw(int b, int a);
  void hold_branches();
  void hold_seams();

  const CoarsenInput& in_;
  std::vector<Triangle> triangles_;  ///< finer numbering; those that are gone have vertex -1
  std::vector<std::array<Vec2, 3>> uvs_;
  std::vector<std::vector<int>> around_;  ///< triangles of each vertex
  std::vector<int> group_, into_;         ///< into_: what a vertex was drawn into, itself if it is left
  std::vector<double> deviation_;         ///< sum of the distances that CoarsenInput::deviation limits [m]
  std::vector<double> size_;              ///< mean length of the edges around a vertex at the start [m]
};

Coarsener::Coarsener(const CoarsenInput& in)
    : in_(in),
      triangles_(in.triangles.begin(), in.triangles.end()),
      uvs_(in.uvs.begin(), in.uvs.end()),
      around_(in.rest.size()),
      group_(in.group.begin(), in.group.end()),
      into_(in.rest.size()),
      deviation_(in.rest.size(), 0.0),
      size_(in.rest.size(), 0.0) {
  CHECK(uvs_.size() == triangles_.size() || (uvs_.empty() && !in.cut));
  CHECK(group_.empty() || group_.size() == in.rest.size());
  group_.resize(in.rest.size(), 0);
  std::iota(into_.begin(), into_.end(), 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const int v : triangles_[t]) around_[at(v)].push_back(static_cast<int>(t));
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
    std::map<int, int> uses;
    for (const int t : around_[v])
      for (const int w : triangles_[at(t)])
        if (w != static_cast<int>(v)) ++uses[w];
    const auto single = std::count_if(uses.begin(), uses.end(), [](const auto& u) { return u.second == 1; });
    const bool branches = std::any_of(uses.begin(), uses.end(), [](const auto& u) { return u.second > 2; });
    const bool degenerate =
        uses.size() < around_[v].size() || std::any_of(around_[v].begin(), around_[v].end(), [&](int t) {
          const Triangle& c = triangles_[at(t)];
          return shape_of(in_.rest[at(c[0])], in_.rest[at(c[1])], in_.rest[at(c[2])]) < 1e-6;
        });
    if (branches || single > 2 || degenerate) group_[v] = k_group_stays;
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

std::vector<int> Coarsener::neighbours(int v) const {
  std::vector<int> out;
  for (const int t : around_[at(v)])
    for (const int w : triangles_[at(t)])
      if (w != v) out.push_back(w);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Triangles at an edge.
std::vector<int> Coarsener::shared(int a, int b) const {
  std::vector<int> out;
  for (const int t : around_[at(b)])
    if (has(triangles_[at(t)], a)) out.push_back(t);
  return out;
}

bool Coarsener::on_outline(int v) const {
  for (const int w : neighbours(v))
    if (shared(v, w).size() == 1) return true;
  return false;
}

std::size_t Coarsener::corner(int t, int v) const {
  const Triangle& c = triangles_[at(t)];
  return c[0] == v ? 0 : c[1] == v ? 1 : 2;
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
  const std::vector<int> of_a = neighbours(a), of_b = neighbours(b);
  if (on_outline(b)) {
    if (gone.size() != 1) return false;
    for (const int w : of_b) {
      if (w == a || shared(b, w).size() != 1) continue;
      const Vec3 u = x[at(a)] - x[at(b)], v = x[at(w)] - x[at(b)];
      if (u.dot(v) > k_straight * u.norm() * v.norm()) return false;
    }
  }
  const std::optional<Vec2> uv = uv_at(a, gone);
  if (!uv) return false;
  std::vector<int> common;
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common));
  if (common.size() != gone.size()) return false;  // a tube would be pinched off
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

void Coarsener::draw(int b, int a) {
  deviation_[at(a)] = std::max(deviation_[at(a)], deviation(b, a));
  const std::vector<int> gone = shared(a, b);
  const Vec2 uv = *uv_at(a, gone);
  for (const int t : gone) {
    for (const int v : triangles_[at(t)])
      if (v != b) std::erase(around_[at(v)], t);
    triangles_[at(t)] = {-1, -1, -1};
  }
  for (const int t : around_[at(b)]) {
    if (triangles_[at(t)][0] < 0) continue;
    const std::size_t k = corner(t, b);
    triangles_[at(t)][k] = a;
    if (!uvs_.empty()) uvs_[at(t)][k] = uv;
    around_[at(a)].push_back(t);
  }
  around_[at(b)].clear();
  into_[at(b)] = a;
}

/// Collapses edges that do not touch each other; false when there was none to collapse.
bool Coarsener::round() {
  std::vector<Triangle> alive;
  for (const Triangle& t : triangles_)
    if (t[0] >= 0) alive.push_back(t);
  std::vector<Collapse> collapses;
  for (const Edge& e : unique_edges(alive)) {
    const double length = (in_.rest[at(e[0])] - in_.rest[at(e[1])]).norm() / wanted(e[0], e[1]);
    if (length < k_short) collapses.push_back({length, e[0], e[1]});
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
    draw(from, to);
    any = true;
  }
  return any;
}

CoarsenedMesh Coarsener::result() const {
  CoarsenedMesh out;
  std::vector<int> number(into_.size(), -1);
  for (std::size_t v = 0; v < into_.size(); ++v)
    if (into_[v] == static_cast<int>(v))
      number[v] = static_cast<int>(out.kept.size()), out.kept.push_back(static_cast<int>(v));
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (triangles_[t][0] < 0) continue;
    out.triangles.push_back({number[at(triangles_[t][0])], number[at(triangles_[t][1])], number[at(triangles_[t][2])]});
    if (!uvs_.empty()) out.uvs.push_back(uvs_[t]);
  }
  out.places.resize(into_.size());
  for (std::size_t v = 0; v < into_.size(); ++v) {
    int left = static_cast<int>(v);
    while (into_[at(left)] != left) left = into_[at(left)];
    const int own = number[at(left)];
    out.places[v].vertex = {own, own, own};
    if (left == static_cast<int>(v)) continue;
    // Near what it was drawn into, not anywhere: another layer of the garment may lie nearer.
    double nearest = std::numeric_limits<double>::infinity();
    std::vector<int> near = neighbours(left);
    near.push_back(left);
    for (const int w : near)
      for (const int t : around_[at(w)]) {
        const Triangle& c = triangles_[at(t)];
        const PairGeometry g =
            vertex_face_geometry(in_.rest[v], in_.rest[at(c[0])], in_.rest[at(c[1])], in_.rest[at(c[2])]);
        if (g.distance >= nearest) continue;
        nearest = g.distance;
        out.places[v].vertex = {number[at(c[0])], number[at(c[1])], number[at(c[2])]};
        out.places[v].weight = {-g.weight[1], -g.weight[2], -g.weight[3]};
      }
  }
  return out;
}

}  // namespace

CoarsenedMesh coarsen_mesh(const CoarsenInput& input) {
  Coarsener mesh(input);
  while (mesh.round()) {
  }
  return mesh.result();
}

}  // namespace ft
