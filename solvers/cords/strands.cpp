// Strands: which cord runs on into which at a knot. As a net is seen: twines that cross, each on its own smooth way,
// and not the sides of its cells.
#include <algorithm>

#include "solvers/cords/cord_graph.h"

namespace ft::inline solvers {
namespace {

constexpr double k_least_cosine =
    0.25;  // of the turn: about 75 degrees, so that squares have corners and hexagons none

/// End `end` (0 or 1) of a cord, as one number.
std::size_t end_of(std::size_t cord, std::size_t end) {
  return 2 * cord + end;
}

struct Pair {
  double cosine;
  std::size_t a, b;  // ends
};

/// Ends at one point, the straightest pairs first; what is left has no partner.
void pair_ends(const CordGraph& graph, std::span<const std::size_t> ends, std::vector<std::ptrdiff_t>& partner) {
  const auto away = [&](std::size_t end) {
    const Edge& cord = graph.cords[end / 2];
    const Vec3 way = graph.points[at(cord[1 - end % 2])] - graph.points[at(cord[end % 2])];
    return way.stableNormalized();
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const double cosine = -away(ends[i]).dot(away(ends[j])); cosine > k_least_cosine)
        pairs.push_back({cosine, ends[j], ends[i]});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) { return p.cosine > q.cosine; });
  for (const Pair& pair : pairs)
    if (partner[pair.a] < 0 && partner[pair.b] < 0) {
      partner[pair.a] = static_cast<std::ptrdiff_t>(pair.b);
      partner[pair.b] = static_cast<std::ptrdiff_t>(pair.a);
    }
}

}  // namespace

void join_strands(CordGraph& graph) {
  std::vector<std::vector<std::size_t>> at_point(graph.points.size());
  for (std::size_t c = 0; c < graph.cords.size(); ++c)
    for (std::size_t k = 0; k < 2; ++k) at_point[at(graph.cords[c][k])].push_back(end_of(c, k));
  std::vector<std::ptrdiff_t> partner(2 * graph.cords.size(), -1);
  for (const auto& ends : at_point) pair_ends(graph, ends, partner);

  std::vector<bool> taken(graph.cords.size(), false);
  const auto follow = [&](std::size_t end) {
    std::vector<int>& strand = graph.strands.emplace_back();
    strand.push_back(graph.cords[end / 2][end % 2]);
    for (std::ptrdiff_t next = static_cast<std::ptrdiff_t>(end);
         next >= 0 && !taken[static_cast<std::size_t>(next) / 2];) {
      const std::size_t near = static_cast<std::size_t>(next), far = near ^ 1;
      taken[near / 2] = true;
      strand.push_back(graph.cords[far / 2][far % 2]);
      next = partner[far];
    }
    const auto held = [&](int point) { return std::binary_search(graph.held.begin(), graph.held.end(), point); };
    if (held(strand.back()) && !held(strand.front())) std::reverse(strand.begin(), strand.end());
  };
  graph.strands.clear();
  for (std::size_t end = 0; end < partner.size(); ++end)
    if (partner[end] < 0 && !taken[end / 2]) follow(end);
  for (std::size_t c = 0; c < taken.size(); ++c)  // what is left are rings
    if (!taken[c]) follow(end_of(c, 0));
}

}  // namespace ft::inline solvers
