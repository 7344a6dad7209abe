// Where the skin holds cloth that has passed a part of the body that is absent.
#include <algorithm>

#include "baker/core/parallel.h"
#include "collision/check/penetration.h"
#include "solvers/cloth/model/absence.h"
#include "solvers/cloth/model/absence_nearest.h"
#include "solvers/cloth/model/cloth_model.h"

namespace ft::inline solvers {

using namespace absent;

namespace {

/// Cloth whose nearest skin is no farther than this from where it lay in the bind pose has slid there [m]; farther away
/// it is on the wrong side. Less for skin of another part.
constexpr double k_same_side = 0.08, k_same_side_elsewhere = 0.03;

}  // namespace

std::vector<SkinHold> Absence::skin_holds(const ClothModel& model, std::span<const Vec3> body,
                                          std::span<const char> deep, const ClothMotion& motion) const {
  std::vector<SkinHold> out;
  TriangleTree tree;
  std::optional<TriangleTree> solid_tree;
  const auto parts = model.collider->part_of_vertex();
  const auto triangles = model.collider->triangles();
  for (int g = 0; g < static_cast<int>(worn_.size()); ++g) {
    Box box;
    std::vector<char> gone(body_count_, 0);
    for (int b = 0; b < static_cast<int>(body_count_); ++b)
      if (motion.absent[place(g, b)] != 0 && !planned(g, b, deep)) gone[at(b)] = 1, box.include(body[at(b)]);
    if (!(box.lo.x() <= box.hi.x())) continue;
    if (tree.empty()) {
      tree = tree_;
      tree.refit(body, triangles);
      solid_tree = tree_of_solids(model, body);
    }
    const TriangleTree& solid = solid_tree ? *solid_tree : tree;
    box.inflate(k_margin);
    const auto is_gone = [&](const Triangle& t) {
      return gone[at(t[0])] != 0 || gone[at(t[1])] != 0 || gone[at(t[2])] != 0;
    };
    const auto is_planned = [&](const Triangle& t) {
      return std::any_of(t.begin(), t.end(), [&](int b) { return planned(g, b, deep); });
    };
    const int first = model.first_vertex[at(g)], count = model.first_vertex[at(g + 1)] - first;
    const TriangleTree gone_tree = tree_of(body, triangles, is_gone);
    std::vector<int> holders;  // what the garment wears and meets
    for (int b = 0; b < static_cast<int>(body_count_); ++b)
      if (motion.absent[place(g, b)] == 0 && worn_[at(g)][at(parts[at(b)])] != 0) holders.push_back(b);
    std::vector<SkinHold> ways(at(count), SkinHold{-1, false, Vec3::Zero(), Vec3::Zero(), -1});
    parallel_for(at(count), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const std::size_t i = at(first) + k;
        const Vec3& p = motion.x[i];
        const Triangle& skin = anchors_[i].triangle;
        const bool may_return = skin[0] >= 0 && is_gone(skin) && !is_planned(skin);
        const bool is_near = (p.array() >= box.lo.array()).all() && (p.array() <= box.hi.array()).all();
        if (!may_return && !is_near) continue;
        // What does not lie on skin stays with what still holds it, until what has passed it is gone.
        if (skin[0] < 0) {
          const Nearest in = nearest(p, body, triangles, gone_tree, k_deepest);
          if (in.triangle < 0 || !in.behind || !rays_say_inside(p, solid, body, triangles)) continue;
          double least = k_on_skin * k_on_skin;
          int holder = -1;
          for (const int b : holders)
            if (const double d = (body[at(b)] - p).squaredNorm(); d < least) least = d, holder = b;
          if (holder >= 0) {
            ways[k] = {static_cast<int>(i), false, Vec3::Zero(), Vec3::Zero(), holder};
            continue;
          }
        }
        const Nearest n = nearest(p, body, triangles, tree, k_deepest);
        if (n.triangle < 0) continue;
        const Triangle& t = triangles[at(n.triangle)];
        const Vec3 place = p + n.distance * n.way_out, normal = normal_of(t, body);
        const bool inside = n.behind && rays_say_inside(p, solid, body, triangles);
        const auto has_slid_there = [&] {
          const double way = (place_on_skin(static_cast<int>(i), body) - place).norm();
          const bool same_part = parts[at(skin[0])] == parts[at(t[0])];
          if (sheet_[at(parts[at(t[0])])] != 0 && n.behind != (anchors_[i].height < 0)) return false;
          return way < (same_part ? k_same_side : k_same_side_elsewhere) && normal.dot(normal_of(skin, body)) > 0;
        };
        if (may_return && (inside || !has_slid_there())) {
          ways[k] = {static_cast<int>(i), true, Vec3::Zero(), Vec3::Zero(), inside ? skin[0] : -1};
          continue;
        }
        if (!is_gone(t) || is_planned(t) || inside != n.behind) continue;
        const bool worn = worn_[at(g)][at(parts[at(t[0])])] != 0;
        ways[k] = {static_cast<int>(i), false, place, normal, inside && worn ? t[0] : -1};
      }
    });
    for (const SkinHold& way : ways)
      if (way.vertex >= 0) out.push_back(way);
  }
  return out;
}

}  // namespace ft::inline solvers
