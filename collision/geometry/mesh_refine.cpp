// See mesh_refine.h. One round splits every long edge once: a triangle with one long edge becomes two, with two three,
// with three four. An edge that needs n pieces is split at n/2 (rounded down) of them, so that an edge of 17 lengths
// becomes 17 pieces, not 32.
#include "collision/geometry/mesh_refine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "baker/core/check.h"

namespace ft::inline collision {
namespace {

constexpr double k_rounding = 1e-9;  ///< edges longer by no more than this share are not long

Edge sorted(int a, int b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

struct Round {
  std::vector<Edge> split;  ///< sorted
  int first_vertex = 0;
  int middle(int a, int b) const {
    const Edge e = sorted(a, b);
    const auto found = std::lower_bound(split.begin(), split.end(), e);
    return found != split.end() && *found == e ? first_vertex + static_cast<int>(found - split.begin()) : -1;
  }
};

/// Adds the pieces of t to out; the number of pieces tells how many edges were split.
void split_triangle(const Triangle& t, const std::array<int, 3>& m, std::span<const Vec3> x,
                    std::vector<Triangle>& out) {
  const int count = (m[0] >= 0) + (m[1] >= 0) + (m[2] >= 0);
  if (count == 0) {
    out.push_back(t);
  } else if (count == 3) {
    out.insert(out.end(), {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, {m[0], m[1], m[2]}});
  } else if (count == 1) {
    const std::size_t k = m[0] >= 0 ? 0 : m[1] >= 0 ? 1 : 2;
    const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
    out.insert(out.end(), {{a, m[k], c}, {m[k], b, c}});
  } else {
    // Rotated so that edge c-a is the whole one: corner b is cut off, the rest is split by its shorter diagonal.
    const std::size_t k = m[0] < 0 ? 1 : m[1] < 0 ? 2 : 0;
    const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], ab = m[k], bc = m[(k + 1) % 3];
    out.push_back({ab, b, bc});
    const double a_bc = (x[at(a)] - x[at(bc)]).squaredNorm(), c_ab = (x[at(c)] - x[at(ab)]).squaredNorm();
    if (a_bc < c_ab)
      out.insert(out.end(), {{a, ab, bc}, {a, bc, c}});
    else
      out.insert(out.end(), {{a, ab, c}, {ab, bc, c}});
  }
}

/// Ends are told apart by position, so that both copies of a seam's edge are split at the same point.
RefinedMesh::Blend split_of(int a, int b, std::span<const Vec3> x, double max_edge) {
  const Vec3 &p = x[at(a)], &q = x[at(b)];
  if (std::lexicographical_compare(q.data(), q.data() + 3, p.data(), p.data() + 3)) std::swap(a, b);
  const double pieces = std::ceil((p - q).norm() / max_edge - k_rounding);
  return {a, b, pieces < 1e6 ? std::floor(pieces / 2) / pieces : 0.5};
}

}  // namespace

void RefinedMesh::positions(std::span<const Vec3> drawn, std::span<Vec3> refined) const {
  CHECK(static_cast<int>(drawn.size()) == drawn_vertex_count && static_cast<int>(refined.size()) == vertex_count());
  std::copy(drawn.begin(), drawn.end(), refined.begin());
  std::size_t v = drawn.size();
  for (const Blend& blend : blends)
    refined[v++] = (1 - blend.share) * refined[at(blend.a)] + blend.share * refined[at(blend.b)];
}

RefinedMesh refine_mesh(std::span<const Vec3> pose, std::span<const Triangle> triangles, double max_edge,
                        std::size_t max_triangles, std::span<const char> whole) {
  CHECK(max_edge > 0);
  RefinedMesh mesh;
  mesh.drawn_vertex_count = static_cast<int>(pose.size());
  mesh.triangles.assign(triangles.begin(), triangles.end());
  mesh.source.resize(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) mesh.source[i] = static_cast<int>(i);
  std::vector<Vec3> x(pose.begin(), pose.end());
  for (;;) {
    Round round;
    round.first_vertex = static_cast<int>(x.size());
    std::size_t pieces = mesh.triangles.size();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      if (!whole.empty() && whole[at(mesh.source[i])] != 0) continue;
      const Triangle& t = mesh.triangles[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        if (a == b || !((x[at(a)] - x[at(b)]).norm() > max_edge * (1 + k_rounding))) continue;
        round.split.push_back(sorted(a, b));
        ++pieces;
      }
    }
    if (round.split.empty() || pieces > max_triangles) return mesh;
    std::sort(round.split.begin(), round.split.end());
    round.split.erase(std::unique(round.split.begin(), round.split.end()), round.split.end());
    for (const Edge& e : round.split) {
      mesh.blends.push_back(split_of(e[0], e[1], x, max_edge));
      const RefinedMesh::Blend& blend = mesh.blends.back();
      x.push_back((1 - blend.share) * x[at(blend.a)] + blend.share * x[at(blend.b)]);
    }
    std::vector<Triangle> next;
    std::vector<int> source;
    next.reserve(pieces);
    source.reserve(pieces);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle& t = mesh.triangles[i];
      const std::array<int, 3> middle{t[0] == t[1] ? -1 : round.middle(t[0], t[1]),
                                      t[1] == t[2] ? -1 : round.middle(t[1], t[2]),
                                      t[2] == t[0] ? -1 : round.middle(t[2], t[0])};
      split_triangle(t, middle, x, next);
      source.resize(next.size(), mesh.source[i]);
    }
    mesh.triangles = std::move(next);
    mesh.source = std::move(source);
  }
}

}  // namespace ft::inline collision
