// Of contact what is asked for around a step: who is in whose way, what is near, what crosses.
#include <algorithm>
#include <utility>

#include "collision/check/crossings.h"
#include "collision/geometry/triangle_tree.h"
#include "solvers/lockstep/lockstep_contact.h"

namespace ft::inline solvers {
namespace {

/// Of what stands in the way, all within so many times the least distance [1].
constexpr double k_hard = 3;

}  // namespace

std::vector<LockstepContact::Blocked> LockstepContact::blocking(std::span<const Vec3> x, bool prop_is_driven,
                                                                double share) const {
  spread(x, share, places_);
  double least = 1;  // of the reach
  struct Nearness {
    double near = 1;
    int met = 0;
  };
  std::vector<Nearness> nearness(at(model_.point_count()));
  for (const Pair& pair : pairs_) {
    if (pair.met == 0 ? !prop_is_driven : pair.met == k_own || !scenery_.moves(pair.met - 1)) continue;
    const double near = pair_geometry(pair.kind, corners(pair, places_)).distance / pair.reach;
    for (const int v : pair.v)
      if (v < model_.point_count() && near < nearness[at(v)].near) nearness[at(v)] = {near, pair.met};
    least = std::min(least, near);
  }
  std::vector<Blocked> out;
  for (int v = 0; v < model_.point_count(); ++v)
    if (nearness[at(v)].near < 1 && nearness[at(v)].near <= k_hard * least) out.push_back({v, nearness[at(v)].met});
  return out;
}

double LockstepContact::fastest_stop(std::span<const Vec3> x, std::span<const Vec3> v_t0, double share) const {
  double fastest = 0;
  for (const Slide& s : slides_) {
    if (s.met < 1) continue;
    Vec3 before = s.given / h_;
    for (int k = 0; k < s.of.count; ++k) before += s.of.weight[at(k)] * v_t0[at(s.of.node[at(k)])];
    fastest = std::max(fastest, s.normal.dot(moved(s, x, share) / h_ - before));
  }
  return fastest;
}

std::vector<std::uint64_t> LockstepContact::near_at(std::span<const Vec3> x) {
  const std::vector<double> kept = std::exchange(let_through_, {});
  find(x, std::vector<Vec3>(x.size(), Vec3::Zero()));
  std::vector<std::uint64_t> out(at(model_.point_count()), 0);
  for (const Pair& pair : pairs_) {
    if (pair.met == k_own || pair_geometry(pair.kind, corners(pair, from_)).distance >= pair.reach) continue;
    for (const int v : pair.v)
      if (v < model_.point_count()) out[at(v)] |= met_bit(pair.met);
  }
  for (const MetCrossing& c : crossings(x))
    for (const int v : c.cord) out[at(v)] |= met_bit(c.met);
  let_through_ = kept;
  return out;
}

/// As of the last find(), which was at x.
std::vector<LockstepContact::MetCrossing> LockstepContact::crossings(std::span<const Vec3> x) {
  std::vector<MetCrossing> out;
  const auto add = [&](std::span<const Vec3> places, std::span<const Triangle> triangles, auto&& met_of) {
    if (triangles.empty()) return;
    const TriangleTree tree(places, triangles);
    for (const Triangle& cord : model_.cords) {
      const Vec3 &p = x[at(cord[0])], &q = x[at(cord[1])];
      tree.for_each_near(TreeBox::around(p.cwiseMin(q), p.cwiseMax(q)), [&](int index) {
        const Triangle& t = triangles[at(index)];
        const int met = met_of(t);
        if (model_.meets(model_.system_of[at(cord[0])], met) &&
            edge_crosses_triangle(p, q, places[at(t[0])], places[at(t[1])], places[at(t[2])]))
          out.push_back({{cord[0], cord[1]}, met});
      });
    }
  };
  model_.spread(x, places_);
  add(places_, model_.skin, [](const Triangle&) { return 0; });
  if (scenery_.empty()) return out;
  Box around;
  for (int i = 0; i < model_.point_count(); ++i) around.include(x[at(i)]);
  near_.cover(around);
  std::vector<Vec3> places(x.begin(), x.begin() + model_.point_count());
  for (const int v : near_.vertices()) places.push_back(scenery_.start(v) + scenery_.way(v));
  add(places, near_.triangles(),
      [&](const Triangle& t) { return 1 + scenery_.body_of(near_.vertices()[at(t[0] - model_.point_count())]); });
  return out;
}

}  // namespace ft::inline solvers
