#include "io/import/motion/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "baker/core/disjoint_sets.h"
#include "baker/core/lids.h"

namespace ft::inline io {
namespace {

/// Openings below this share of the area are not worth a word [1].
constexpr double k_told_share = 2e-3;

/// Edges of one triangle only.
std::vector<Edge> rim_edges(std::span<const Triangle> triangles, std::span<const int> first) {
  std::vector<Edge> edges, out;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = first[at(t[k])], b = first[at(t[(k + 1) % 3])];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    const std::size_t begin = i;
    while (i < edges.size() && edges[i] == edges[begin]) ++i;
    if (i - begin == 1) out.push_back(edges[begin]);
  }
  return out;
}

}  // namespace

Openings openings_of(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  Openings out;
  for (const Triangle& t : triangles)
    out.surface += 0.5 * (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]).norm();
  const std::vector<Edge> rim = rim_edges(triangles, first_in_place(x));
  DisjointSets rims(x.size());
  for (const Edge& e : rim) rims.join(e[0], e[1]);
  std::vector<Vec3> middle(x.size(), Vec3::Zero());  // at the root
  std::vector<double> length(x.size(), 0.0);
  for (const Edge& e : rim) {
    const std::size_t root = at(rims.root(e[0]));
    const double own = (x[at(e[0])] - x[at(e[1])]).norm();
    middle[root] += 0.5 * own * (x[at(e[0])] + x[at(e[1])]);
    length[root] += own;
  }
  for (const Edge& e : rim) {
    const std::size_t root = at(rims.root(e[0]));
    if (!(length[root] > 0)) continue;
    const Vec3 o = middle[root] / length[root];
    out.area += 0.5 * (x[at(e[0])] - o).cross(x[at(e[1])] - o).norm();
  }
  return out;
}

std::string openings_note(const Openings& openings, bool is_sheet) {
  if (openings.share() < k_told_share) return {};
  const std::string open =
      fmt::format("its mesh is open, by {:.2g} % of its area: it is taken as ", 100 * openings.share());
  return is_sheet ? open + "a sheet with two sides and no inside (surface = \"solid\" makes it a body)"
                  : open + "a body with an inside (surface = \"sheet\" makes it cloth with two sides)";
}

}  // namespace ft::inline io
