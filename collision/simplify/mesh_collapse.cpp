#include "collision/simplify/mesh_collapse.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>

#include "baker/core/check.h"
#include "collision/geometry/pair_geometry.h"

namespace ft::inline collision {
namespace {

bool has(const Triangle& t, int v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

}  // namespace

double shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double sum = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return sum > 0 ? 4 * std::sqrt(3.0) * triangle_area(a, b, c) / sum : 0;
}

CollapsingMesh::CollapsingMesh(std::span<const Vec3> rest, std::span<const Triangle> triangles,
                               std::span<const std::array<Vec2, 3>> uvs)
    : rest_(rest),
      triangles_(triangles.begin(), triangles.end()),
      uvs_(uvs.begin(), uvs.end()),
      around_(rest.size()),
      into_(rest.size()) {
  CHECK(uvs_.empty() || uvs_.size() == triangles_.size());
  std::iota(into_.begin(), into_.end(), 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const int v : triangles_[t]) around_[at(v)].push_back(static_cast<int>(t));
}

std::vector<int> CollapsingMesh::neighbours(int v) const {
  std::vector<int> out;
  for (const int t : around_[at(v)])
    for (const int w : triangles_[at(t)])
      if (w != v) out.push_back(w);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<int> CollapsingMesh::shared(int a, int b) const {
  std::vector<int> out;
  for (const int t : around_[at(b)])
    if (has(triangles_[at(t)], a)) out.push_back(t);
  return out;
}

bool CollapsingMesh::on_outline(int v) const {
  for (const int w : neighbours(v))
    if (shared(v, w).size() == 1) return true;
  return false;
}

bool CollapsingMesh::branches(int v) const {
  std::map<int, int> uses;
  for (const int t : around_[at(v)])
    for (const int w : triangles_[at(t)])
      if (w != v) ++uses[w];
  const auto single = std::count_if(uses.begin(), uses.end(), [](const auto& u) { return u.second == 1; });
  return single > 2 || uses.size() < around_[at(v)].size() ||
         std::any_of(uses.begin(), uses.end(), [](const auto& u) { return u.second > 2; });
}

std::size_t CollapsingMesh::corner(int t, int v) const {
  const Triangle& c = triangles_[at(t)];
  return c[0] == v ? 0 : c[1] == v ? 1 : 2;
}

bool CollapsingMesh::keeps_topology(int b, int a, std::span<const int> gone) const {
  if (on_outline(b) && gone.size() != 1) return false;
  const std::vector<int> of_a = neighbours(a), of_b = neighbours(b);
  std::vector<int> common;
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common));
  return common.size() == gone.size();  // else a tube would be pinched off
}

std::optional<Vec2> CollapsingMesh::uv_after(const Vec2& uv, int b, int a, std::span<const int> gone) const {
  std::optional<Vec2> out;
  for (const int t : gone) {
    if (uvs_[at(t)][corner(t, b)] != uv) continue;
    const Vec2& other = uvs_[at(t)][corner(t, a)];
    if (out && *out != other) return {};
    out = other;
  }
  return out;
}

void CollapsingMesh::draw(int b, int a) {
  const std::vector<int> gone = shared(a, b);
  for (const int t : around_[at(b)]) {
    if (uvs_.empty() || has(triangles_[at(t)], a)) continue;
    Vec2& uv = uvs_[at(t)][corner(t, b)];
    uv = uv_after(uv, b, a, gone).value_or(uv);
  }
  for (const int t : gone) {
    for (const int v : triangles_[at(t)])
      if (v != b) std::erase(around_[at(v)], t);
    triangles_[at(t)] = {-1, -1, -1};
  }
  for (const int t : around_[at(b)]) {
    if (triangles_[at(t)][0] < 0) continue;
    triangles_[at(t)][corner(t, b)] = a;
    around_[at(a)].push_back(t);
  }
  around_[at(b)].clear();
  into_[at(b)] = a;
}

CoarsenedMesh CollapsingMesh::result() const {
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
    out.into.push_back(own);
    out.places[v].vertex = {own, own, own};
    if (left == static_cast<int>(v)) continue;
    // Near what it was drawn into, not anywhere: another layer of the garment may lie nearer.
    double nearest = std::numeric_limits<double>::infinity();
    std::vector<int> near = neighbours(left);
    near.push_back(left);
    for (const int w : near)
      for (const int t : around_[at(w)]) {
        const Triangle& c = triangles_[at(t)];
        const PairGeometry g = vertex_face_geometry(rest_[v], rest_[at(c[0])], rest_[at(c[1])], rest_[at(c[2])]);
        if (g.distance >= nearest) continue;
        nearest = g.distance;
        out.places[v].vertex = {number[at(c[0])], number[at(c[1])], number[at(c[2])]};
        out.places[v].weight = {-g.weight[1], -g.weight[2], -g.weight[3]};
      }
  }
  return out;
}

}  // namespace ft::inline collision
