#include "solvers/lockstep/lockstep_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "baker/core/parallel.h"
#include "collision/check/crossings.h"
#include "collision/geometry/ccd_li2021.h"
#include "collision/geometry/triangle_tree.h"
#include "solvers/lockstep/contact_laws.h"

namespace ft::inline solvers {
namespace {

/// Slip speed below which friction grows to its full force [m/s].
constexpr double k_sliding_speed = 1e-3;

/// Contact with scenery pushes back twice as hard as at rest against what approaches at this speed. 0.01 is as dead as
/// sand, 1 bounces [m/s].
constexpr double k_dead_speed = 0.05;

/// Nearer to rest than so many times the slip at which friction is full, its tangent is what stiffness is made of [1].
constexpr double k_near = 300;

}  // namespace

LockstepContact::LockstepContact(const LockstepModel& model)
    : model_(model),
      finder_(model.point_count(), model.cords, static_cast<int>(model.skin_weights.size()), model.skin),
      scenery_(model.setup.bodies),
      near_(scenery_, model.point_count(), model.cords) {
  for (const CordSystem& c : model.setup.cords) {
    self_ = self_ || c.self_collision;
    widest_reach_ = std::max(widest_reach_, 2 * c.radius);
  }
}

void LockstepContact::forget_gap() {
  smallest_gap_ = std::numeric_limits<double>::infinity();
}

void LockstepContact::push_pairs(const PairList& from, PairKind kind) {
  const int points = model_.point_count(), split = first_feature_size(kind);
  for (const PairKey key : from.of(kind)) {
    const Stencil s = from.features.stencil(kind, key);
    Pair pair{kind, s.v, 0, 0, k_own};
    // One side may be the prop; the other, or both, are cords.
    int first = s.v[0], second = s.v[at(split)];
    if (first >= points || second >= points) pair.met = 0;
    if (first >= points) std::swap(first, second);
    if (pair.met == 0 && passes(s.v, 0)) continue;
    const CordSystem& a = model_.cords_of(first);
    if (pair.met == 0) {
      pair.reach = 2 * a.radius;
      pair.friction = a.friction;
    } else {
      const CordSystem& b = model_.cords_of(second);
      if (!a.self_collision || !b.self_collision) continue;
      pair.reach = a.radius + b.radius;
      pair.friction = std::min(a.friction, b.friction);
      // Cords that rest closer than this are neighbours, and never repel each other.
      const std::array<Vec3, 4> rest{model_.start[at(s.v[0])], model_.start[at(s.v[1])], model_.start[at(s.v[2])],
                                     model_.start[at(s.v[3])]};
      if (pair_geometry(kind, rest).distance < pair.reach) continue;
    }
    pairs_.push_back(pair);
  }
}

/// Of cords and scenery, which the finder numbers right behind the points.
void LockstepContact::push_scenery_pairs(const PairList& from, PairKind kind) {
  const int points = model_.point_count(), skin = model_.place_count() - points;
  for (const PairKey key : from.of(kind)) {
    Stencil s = from.features.stencil(kind, key);
    int cord = -1, met = k_own;
    for (int& v : s.v) {
      if (v < points) {
        cord = v;
        continue;
      }
      met = 1 + scenery_.body_of(near_.vertices()[at(v - points)]);
      v += skin;
    }
    if (!model_.meets(model_.system_of[at(cord)], met) || passes(s.v, met)) continue;
    const CordSystem& system = model_.cords_of(cord);
    pairs_.push_back({kind, s.v, 2 * system.radius, system.friction, met});
  }
}

bool LockstepContact::passes(const std::array<int, 4>& v, int met) const {
  return !let_through_.empty() && std::any_of(v.begin(), v.end(), [&](int i) {
    return i < model_.point_count() && (static_cast<std::uint64_t>(let_through_[at(i)]) & met_bit(met)) != 0;
  });
}

void LockstepContact::begin_step(double t0, double t1) {
  scenery_.begin_step(t0, t1);
  if (scenery_.any_moves()) near_.forget();
}

/// Nodes -> all places, with the scenery where a share of its way has brought it.
void LockstepContact::spread(std::span<const Vec3> x, double share, std::vector<Vec3>& places) const {
  model_.spread(x, places);
  for (const int v : near_.vertices()) places.push_back(scenery_.start(v) + share * scenery_.way(v));
}

void LockstepContact::find(std::span<const Vec3> x, std::span<const Vec3> dx, double share) {
  model_.spread(x, from_);
  model_.spread(dx, way_);
  const std::size_t points = at(model_.point_count());
  if (!scenery_.empty()) {
    Box swept;
    for (std::size_t i = 0; i < points; ++i) swept.include(from_[i]), swept.include(Vec3(from_[i] + way_[i]));
    swept.inflate(widest_reach_);
    near_.cover(swept);
    for (const int v : near_.vertices()) {
      from_.push_back(scenery_.start(v) + share * scenery_.way(v));
      way_.push_back((1 - share) * scenery_.way(v));
    }
  }
  const BoxFrame frame = frame_around(std::span(from_).first(points), std::span(way_).first(points), widest_reach_);
  boxes_.clear();
  for (std::size_t i = 0; i < from_.size(); ++i)
    boxes_.push_back(frame.swept(from_[i], from_[i] + way_[i], 0.5 * widest_reach_));
  const std::size_t own = at(model_.place_count());
  finder_.arrange(std::span(from_).first(own));
  PairList found;
  finder_.find(std::span(boxes_).first(own), self_, found);
  pairs_.clear();
  push_pairs(found, PairKind::k_vertex_face);
  push_pairs(found, PairKind::k_edge_edge);
  if (near_.vertices().empty()) return;
  const auto without_skin = [&](auto& all) {
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(points), all.begin() + static_cast<std::ptrdiff_t>(own));
  };
  std::vector<Vec3> places = from_;
  without_skin(places);
  without_skin(boxes_);
  near_.find(boxes_, places, found);
  push_scenery_pairs(found, PairKind::k_vertex_face);
  push_scenery_pairs(found, PairKind::k_edge_edge);
}

std::array<Vec3, 4> LockstepContact::corners(const Pair& pair, std::span<const Vec3> places) const {
  return {places[at(pair.v[0])], places[at(pair.v[1])], places[at(pair.v[2])], places[at(pair.v[3])]};
}

double LockstepContact::free_share() const {
  constexpr std::size_t k_block = 64;
  std::vector<double> share(block_count(pairs_.size(), k_block), 1);
  parallel_for(pairs_.size(), k_block, [&](std::size_t begin, std::size_t end) {
    double& least = share[begin / k_block];
    for (std::size_t i = begin; i < end; ++i) {
      const auto x = corners(pairs_[i], from_);
      auto dx = corners(pairs_[i], way_);
      for (Vec3& d : dx) d *= least;
      least *= ccd_time(pairs_[i].kind, x, dx);
    }
  });
  return share.empty() ? 1 : *std::min_element(share.begin(), share.end());
}

bool LockstepContact::meets_prop() const {
  return std::any_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
    if (pair.met != 0) return false;
    const auto x = corners(pair, from_);
    return pair_geometry(pair.kind, x).distance < pair.reach + largest_relative_motion(pair.kind, corners(pair, way_));
  });
}

double LockstepContact::value(std::span<const Vec3> x, double share) const {
  spread(x, share, places_);
  double sum = 0;
  for (const Pair& pair : pairs_) {
    const auto corner = corners(pair, places_);
    if (box_gap_squared(pair.kind, corner) >= pair.reach * pair.reach) continue;
    const double d = pair_geometry(pair.kind, corner).distance;
    smallest_gap_ = std::min(smallest_gap_, d);
    sum += barrier(d, pair.reach, model_.contact_stiffness).energy;
  }
  for (const Slide& s : slides_) {
    const Vec3 u = moved(s, x, share);
    sum += s.limit * friction_energy((s.across * u).norm(), sliding_);
    if (s.dashpot > 0) sum += 0.5 * s.dashpot / h_ * std::pow(std::min(0.0, s.normal.dot(u)), 2);
  }
  return sum;
}

NodeTerm LockstepContact::combination(const Pair& pair, const PairGeometry& geometry) const {
  NodeTerm out;
  for (std::size_t k = 0; k < 4; ++k)
    if (geometry.weight[k] != 0 && pair.v[k] < model_.place_count())
      model_.add_place(pair.v[k], geometry.weight[k], out);
  return out;
}

/// How far the whole way of the scenery moves the two sides of a pair against each other [m].
Vec3 LockstepContact::given(const Pair& pair, const PairGeometry& geometry) const {
  Vec3 out = Vec3::Zero();
  if (pair.met < 1) return out;
  for (std::size_t k = 0; k < 4; ++k)
    if (pair.v[k] >= model_.place_count())
      out += geometry.weight[k] * scenery_.way(near_.vertices()[at(pair.v[k] - model_.place_count())]);
  return out;
}

/// visit(term, what is met or k_own).
template <class Visit>
void LockstepContact::for_each_term(std::span<const Vec3> x, double far, double share, Visit&& visit) const {
  spread(x, share, places_);
  for (const Pair& pair : pairs_) {
    const auto corner = corners(pair, places_);
    if (box_gap_squared(pair.kind, corner) >= pair.reach * pair.reach) continue;
    const PairGeometry geometry = pair_geometry(pair.kind, corner);
    smallest_gap_ = std::min(smallest_gap_, geometry.distance);
    if (geometry.distance >= pair.reach || geometry.distance <= 0) continue;
    const Barrier b = barrier(geometry.distance, pair.reach, model_.contact_stiffness);
    NodeTerm term = combination(pair, geometry);
    term.force = b.slope * geometry.normal;
    term.stiffness = b.curvature * geometry.normal * geometry.normal.transpose();
    if (pair.met > 0) term.ahead = (1 - share) * (term.stiffness * given(pair, geometry));
    visit(term, pair.met);
  }
  for (const Slide& s : slides_) {
    const Vec3 all = moved(s, x, share), u = s.across * all;
    const double size = u.norm();
    const double secant = size > 0 ? friction_slope(size, sliding_) / size : 2 / sliding_;
    NodeTerm term = s.of;
    term.force = s.limit * secant * u;
    term.stiffness = s.limit * secant * s.across;
    if (size > 0 && far < k_near * sliding_) {
      const Vec3 along = u / size;
      term.stiffness -= s.limit * (secant - friction_curvature(size, sliding_)) * along * along.transpose();
    }
    if (const double apart = s.normal.dot(all); s.dashpot > 0 && apart < 0) {
      term.force += s.dashpot / h_ * apart * s.normal;
      term.stiffness += s.dashpot / h_ * s.normal * s.normal.transpose();
    }
    if (s.met > 0) term.ahead = (1 - share) * (term.stiffness * s.given);
    visit(term, s.met);
  }
}

void LockstepContact::add_terms(std::span<const Vec3> x, std::vector<NodeTerm>& out, double far, double share) const {
  for_each_term(x, far, share, [&](const NodeTerm& term, int) { out.push_back(term); });
}

std::vector<Wrench> LockstepContact::on_met(std::span<const Vec3> x, double share) const {
  const std::size_t met_count = model_.met_count();
  std::vector<Wrench> out(model_.setup.cords.size() * met_count);
  const int points = model_.point_count();
  std::vector<NodeTerm> terms;
  std::vector<int> met_by_term;
  for_each_term(x, 0, share, [&](const NodeTerm& term, int met) { terms.push_back(term), met_by_term.push_back(met); });
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const NodeTerm& t = terms[i];
    const int met = met_by_term[i];
    if (met == k_own) continue;
    int system = -1;
    for (int k = 0; k < t.count; ++k)
      if (t.node[at(k)] < points) system = model_.system_of[at(t.node[at(k)])];
    Wrench& sum = out[at(system) * met_count + at(met)];
    for (int k = 0; k < t.count; ++k) {
      const Vec3& place = x[at(t.node[at(k)])];
      if (met == 0 && t.node[at(k)] >= points) sum.add(place, -t.weight[at(k)] * t.force);
      if (met > 0) sum.add(place, t.weight[at(k)] * t.force);  // scenery is no node: what pushes the cord back
    }
  }
  return out;
}

/// How far the two sides of a contact have moved against each other in the step [m].
Vec3 LockstepContact::moved(const Slide& slide, std::span<const Vec3> x, double share) const {
  Vec3 u = share * slide.given;
  for (int k = 0; k < slide.of.count; ++k)
    u += slide.of.weight[at(k)] * (x[at(slide.of.node[at(k)])] - slide_start_[at(slide.of.node[at(k)])]);
  return u;
}

void LockstepContact::lag_friction(std::span<const Vec3> x, std::span<const Vec3> x_t0, double h, double share) {
  slides_.clear();
  slide_start_.assign(x_t0.begin(), x_t0.end());
  sliding_ = k_sliding_speed * h;
  h_ = h;
  spread(x, share, places_);
  for (const Pair& pair : pairs_) {
    if (pair.friction <= 0 && pair.met < 1) continue;
    const auto corner = corners(pair, places_);
    if (box_gap_squared(pair.kind, corner) >= pair.reach * pair.reach) continue;
    const PairGeometry g = pair_geometry(pair.kind, corner);
    if (g.distance >= pair.reach || g.distance <= 0) continue;
    Slide& s = slides_.emplace_back();
    s.of = combination(pair, g);
    s.across = Mat3::Identity() - g.normal * g.normal.transpose();
    s.met = pair.met;
    s.given = given(pair, g);
    const double pressed = -barrier(g.distance, pair.reach, model_.contact_stiffness).slope;
    s.normal = g.normal;
    s.dashpot = pair.met > 0 ? pressed / k_dead_speed : 0;
    const double approach = s.dashpot > 0 ? std::max(0.0, -s.normal.dot(moved(s, x, share))) : 0;
    s.limit = pair.friction * (pressed + s.dashpot / h * approach);
  }
}

}  // namespace ft::inline solvers
