// Parts of the body in which cloth is caught.
#include <algorithm>

#include "solvers/cloth/model/absence.h"
#include "solvers/cloth/model/absence_nearest.h"
#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {
namespace {

/// A garment is caught where it is stretched by this share [1], so near to what it does not wear, in contact radii; and
/// where that goes for this share of its edges [1], for single ones of tight clothes are.
constexpr double k_caught = 0.25, k_caught_reach = 2, k_caught_edges = 0.005;

}  // namespace

void Absence::add_descendants(std::vector<char>& gone) const {
  bool more = true;
  while (more) {
    more = false;
    for (std::size_t p = 0; p < parents_.size(); ++p)
      if (gone[p] == 0 && parents_[p] >= 0 && gone[at(parents_[p])] != 0) gone[p] = 1, more = true;
  }
}

void Absence::let_go_of_what_caught(const ClothModel& model, const CheckedSurface& collider,
                                    ClothMotion& motion) const {
  const auto parts = model.collider->part_of_vertex();
  std::vector<std::vector<char>> gone(worn_.size(), std::vector<char>(parents_.size(), 0));
  const RestEdges& rest = model.rest_edges;
  std::vector<int> edges(worn_.size(), 0), stretched_count(worn_.size(), 0);
  std::vector<Edge> stretched;
  for (std::size_t e = 0; e < rest.edges.size(); ++e) {
    const auto [a, b] = rest.edges[e];
    const std::size_t g = at(model.garment_of(a));
    ++edges[g];
    if ((motion.x[at(a)] - motion.x[at(b)]).norm() < (1 + k_caught) * rest.lengths[e]) continue;
    ++stretched_count[g];
    stretched.push_back(rest.edges[e]);
  }
  bool any = false;
  for (const auto& [a, b] : stretched) {
    const int g = model.garment_of(a);
    if (stretched_count[at(g)] < k_caught_edges * edges[at(g)]) continue;
    for (const int v : {a, b}) {
      const double reach = k_caught_reach * model.contact.radius[at(v)];
      const absent::Nearest n =
          absent::nearest(motion.x[at(v)], collider.positions(), collider.triangles(), collider.tree(), reach);
      if (n.triangle < 0) continue;
      const Triangle& t = collider.triangles()[at(n.triangle)];
      const int part = parts[at(t[0])];
      if (!goes_whole(g, part) || is_absent(motion.absent, g, t)) continue;
      gone[at(g)][at(part)] = 1;
      any = true;
    }
  }
  if (!any) return;
  for (int g = 0; g < static_cast<int>(worn_.size()); ++g) {
    add_descendants(gone[at(g)]);
    for (int b = 0; b < static_cast<int>(body_count_); ++b)
      if (gone[at(g)][at(parts[at(b)])] != 0) motion.absent[place(g, b)] = 1;
  }
}

}  // namespace ft::inline solvers
