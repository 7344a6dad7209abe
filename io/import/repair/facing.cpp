// A piece is what vertices join, and a patch of it what edges of two triangles join. Within a patch faces agree when
// both triangles of every such edge run along it in opposite directions; a disjoint-set forest with parities says how
// each triangle is wound against the patch's root (a Moebius strip contradicts itself). A patch is closed when nearly
// all of its edges have two of its triangles; characters often lack a few faces (the cut of a neck, the inside of a
// sleeve), and count as closed up to a twentieth of the edges. What is left of a piece without its closed patches is
// looked at as one. The sign of the volume about its middle says which way it faces; an open one's sign is only
// believed when it is nothing like zero, and without it the larger area has its way.
#include "io/import/repair/facing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/core/lids.h"
#include "baker/core/mesh.h"

namespace ft::inline io {
namespace {

constexpr double k_most_open_edges = 0.05;  ///< of the edges of a shell that counts as closed
/// Volume over area to the power 3/2: 0.094 of a ball, about 0.03 of a person, 0.014 of a stick 100 times as long as
/// thick. Below it a shell is a sheet, and has no inside.
constexpr double k_flat = 1e-3;

struct HalfEdge {
  Edge edge;
  int triangle;
  bool forward;
};

/// By edge, and then by triangle.
std::vector<HalfEdge> half_edges(std::span<const Triangle> triangles) {
  std::vector<HalfEdge> out;
  out.reserve(3 * triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = triangles[i][k], b = triangles[i][(k + 1) % 3];
      if (a != b) out.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(i), a < b});
    }
  std::sort(out.begin(), out.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.triangle < b.triangle;
  });
  return out;
}

template <class Visit>
void for_each_edge(const std::vector<HalfEdge>& half, Visit visit) {
  for (std::size_t begin = 0, end = 0; begin < half.size(); begin = end) {
    for (end = begin; end < half.size() && half[end].edge == half[begin].edge;) ++end;
    visit(std::span(half).subspan(begin, end - begin));
  }
}

/// Sets of triangles, each with its winding against the root's: 1 the other way round.
class Patches {
 public:
  explicit Patches(std::size_t count) : parent_(count), parity_(count, 0), contradicts_(count, 0) {
    for (std::size_t i = 0; i < count; ++i) parent_[i] = static_cast<int>(i);
  }
  /// Its root, and whether it is wound against it.
  std::pair<int, int> find(int i) {
    int odd = 0;
    while (parent_[at(i)] != i) {
      const int up = parent_[at(i)];
      parity_[at(i)] = static_cast<char>(parity_[at(i)] ^ parity_[at(up)]);  // 0 of a root
      parent_[at(i)] = parent_[at(up)];
      odd ^= parity_[at(i)];
      i = parent_[at(i)];
    }
    return {i, odd};
  }
  /// odd: they are wound against each other.
  void join(int a, int b, int odd) {
    const auto [root_a, odd_a] = find(a);
    const auto [root_b, odd_b] = find(b);
    odd ^= odd_a ^ odd_b;
    if (root_a == root_b) {
      if (odd != 0) contradicts_[at(root_a)] = 1;
      return;
    }
    const int low = std::min(root_a, root_b), high = std::max(root_a, root_b);
    parent_[at(high)] = low, parity_[at(high)] = static_cast<char>(odd);
    contradicts_[at(low)] = contradicts_[at(low)] != 0 || contradicts_[at(high)] != 0;
  }
  bool contradicts(int root) const { return contradicts_[at(root)] != 0; }

 private:
  std::vector<int> parent_;
  std::vector<char> parity_, contradicts_;
};

/// A closed patch, or the rest of a piece.
struct Shell {
  double edges = 0, open = 0;
  double volume = 0, area = 0;
  Vec3 middle = Vec3::Zero();
  double corners = 0;
  int triangles = 0, against = 0;  ///< and of these wound against the file's
  bool disagrees = false, one_sided = false;
};

struct Measure {
  std::vector<double> edges, open;  ///< by number of the shell
};

/// Edges of each set of triangles, and those without exactly one of its triangles each way.
Measure count_edges(const std::vector<HalfEdge>& half, std::span<const int> set_of, std::span<const char> turn,
                    std::size_t sets) {
  Measure out{std::vector<double>(sets, 0.0), std::vector<double>(sets, 0.0)};
  std::vector<std::pair<int, int>> seen;  // set, direction
  for_each_edge(half, [&](std::span<const HalfEdge> edge) {
    seen.clear();
    for (const HalfEdge& h : edge)
      seen.emplace_back(set_of[at(h.triangle)], h.forward != (turn[at(h.triangle)] != 0) ? 1 : -1);
    std::sort(seen.begin(), seen.end());
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
      int along = 0;
      for (end = begin; end < seen.size() && seen[end].first == seen[begin].first; ++end) along += seen[end].second;
      ++out.edges[at(seen[begin].first)];
      if (end - begin != 2 || along != 0) ++out.open[at(seen[begin].first)];
    }
  });
  return out;
}

}  // namespace

std::vector<std::string> FacingReport::notes() const {
  std::vector<std::string> out;
  if (turned_count > 0 && piece_count == 1)
    out.push_back(fmt::format(
        "its surface is inside out (its faces point into the {:.3g} m3 that they enclose): turned", volume));
  else if (turned_count > 0)
    out.push_back(fmt::format(
        "{} of its {} closed pieces {} inside out (faces point into the {:.3g} m3 that they enclose): turned",
        turned_count, piece_count, turned_count == 1 ? "is" : "are", volume));
  if (disagreeing_count > 0)
    out.push_back(fmt::format(
        "the faces of {} of its surface disagree about which way is out: {} of {} are turned, so that they agree",
        disagreeing_count == 1 ? std::string("a piece") : fmt::format("{} pieces", disagreeing_count),
        disagreeing_turned, disagreeing_faces));
  if (one_sided_count > 0)
    out.push_back(fmt::format(
        "{} of its surface ({} faces) {} a single side, as a Moebius strip has: no outside can be told, and contact "
        "takes the faces as the file has them",
        one_sided_count == 1 ? std::string("a piece") : fmt::format("{} pieces", one_sided_count), one_sided_faces,
        one_sided_count == 1 ? "has" : "have"));
  return out;
}

FacingReport turn_outwards(std::span<const Vec3> positions, std::vector<Triangle>& triangles) {
  const std::size_t count = triangles.size();
  // A seam of texture or normals, where vertices are split, is no rim.
  const std::vector<int> first = first_in_place(positions);
  std::vector<Triangle> joined = triangles;
  for (Triangle& t : joined)
    for (int& v : t) v = first[at(v)];
  const std::vector<HalfEdge> half = half_edges(joined);
  Patches patches(count);
  for_each_edge(half, [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 2 && edge[0].triangle != edge[1].triangle)
      patches.join(edge[0].triangle, edge[1].triangle, edge[0].forward == edge[1].forward ? 1 : 0);
  });
  const auto area_of = [&](const Triangle& t) {
    return 0.5 * (positions[at(t[1])] - positions[at(t[0])]).cross(positions[at(t[2])] - positions[at(t[0])]).norm();
  };

  // Faces of a patch agree with the larger part of its area.
  std::vector<int> patch_of(count);
  std::vector<char> odd(count);
  std::vector<double> along(count, 0.0), against(count, 0.0);  // at the root
  for (std::size_t i = 0; i < count; ++i) {
    const auto [root, parity] = patches.find(static_cast<int>(i));
    patch_of[i] = root, odd[i] = static_cast<char>(parity);
    (parity != 0 ? against : along)[at(root)] += area_of(triangles[i]);
  }
  std::vector<char> turn(count, 0);  // within one that contradicts itself the file's winding stays
  for (std::size_t i = 0; i < count; ++i)
    if (const auto root = at(patch_of[i]); !patches.contradicts(patch_of[i]))
      turn[i] = (odd[i] != 0) != (against[root] > along[root]);

  // Shells: a patch that is closed, else what is left of its piece.
  int piece_count = 0;
  const std::vector<int> piece_of = connected_pieces(static_cast<int>(positions.size()), joined, piece_count);
  const Measure of_patch = count_edges(half, patch_of, turn, count);
  std::vector<int> shell_of(count), shell_of_patch(count, -1), shell_of_piece(at(piece_count), -1);
  std::vector<Shell> shells;
  for (std::size_t i = 0; i < count; ++i) {
    const auto root = at(patch_of[i]);
    const bool closed = of_patch.open[root] <= k_most_open_edges * of_patch.edges[root];
    const bool apart = closed || patches.contradicts(patch_of[i]);
    int& shell = apart ? shell_of_patch[root] : shell_of_piece[at(piece_of[at(joined[i][0])])];
    if (shell < 0) shell = static_cast<int>(shells.size()), shells.emplace_back();
    shell_of[i] = shell;
  }
  const Measure of_shell = count_edges(half, shell_of, turn, shells.size());
  for (std::size_t s = 0; s < shells.size(); ++s)
    shells[s].edges = of_shell.edges[s], shells[s].open = of_shell.open[s];
  for (std::size_t i = 0; i < count; ++i) {
    Shell& shell = shells[at(shell_of[i])];
    for (const int v : triangles[i]) shell.middle += positions[at(v)], ++shell.corners;
    ++shell.triangles;
    shell.against += turn[i];
    shell.disagrees = shell.disagrees || (against[at(patch_of[i])] > 0 && along[at(patch_of[i])] > 0);
    shell.one_sided = shell.one_sided || patches.contradicts(patch_of[i]);
  }
  for (Shell& shell : shells) shell.middle /= shell.corners;
  for (std::size_t i = 0; i < count; ++i) {
    Shell& shell = shells[at(shell_of[i])];
    const Triangle& t = triangles[i];
    const Vec3 a = positions[at(t[0])] - shell.middle, b = positions[at(t[1])] - shell.middle,
               c = positions[at(t[2])] - shell.middle;
    shell.volume += (turn[i] != 0 ? -1 : 1) * a.dot(b.cross(c)) / 6;
    shell.area += 0.5 * (b - a).cross(c - a).norm();
  }

  FacingReport out;
  std::vector<char> inside_out(shells.size(), 0);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    Shell& shell = shells[s];
    const bool has_inside = shell.open <= k_most_open_edges * shell.edges && shell.edges > 0 &&
                            std::abs(shell.volume) > k_flat * std::pow(shell.area, 1.5);
    inside_out[s] = has_inside && !(shell.volume > 0);
    if (has_inside) ++out.piece_count;
    if (shell.one_sided && inside_out[s] == 0) ++out.one_sided_count, out.one_sided_faces += shell.triangles;
    if (shell.disagrees && !shell.one_sided) {
      ++out.disagreeing_count, out.disagreeing_faces += shell.triangles;
      out.disagreeing_turned += inside_out[s] != 0 ? shell.triangles - shell.against : shell.against;
    } else if (inside_out[s] != 0) {
      ++out.turned_count;
      out.volume -= shell.volume;
    }
  }
  for (std::size_t i = 0; i < count; ++i)
    if ((turn[i] ^ inside_out[at(shell_of[i])]) != 0) std::swap(triangles[i][1], triangles[i][2]);
  return out;
}

}  // namespace ft::inline io
