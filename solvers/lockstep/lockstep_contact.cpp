#include "solvers/lockstep/lockstep_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "baker/core/parallel.h"
#include "collision/check/crossings.h"
#include "collision/geometry/ccd_li2021.h"
#include "collision/geometry/triangle_tree.h"

namespace ft::inline solvers {
namespace {

/// Slip speed below which friction grows to its full force [m/s].
constexpr double k_sliding_speed = 1e-3;

/// Nearer to rest than so many times the slip at which friction is full, its tangent is what stiffness is made of [1].
constexpr double k_near = 300;

/// Of what stands in the way, all within so many times the least distance [1].
constexpr double k_hard = 3;

struct Barrier {
  double energy = 0, slope = 0, curvature = 0;
};

Barrier barrier(double d, double reach, double k) {
  if (d >= reach) return {};
  if (d <= 0) return {std::numeric_limits<double>::infinity(), 0, 0};
  const double in = d - reach, log = std::log(d / reach);
  return {-k * in * in * log, -k * (2 * in * log + in * in / d), -k * (2 * log + 4 * in / d - in * in / (d * d))};
}

/// Friction's potential by slip, over the full force, with its slope and curvature (Li et al. 2020, eq. 15).
double friction_energy(double slip, double full) {
  return slip >= full ? slip : slip * slip / full * (1 - slip / (3 * full)) + full / 3;
}
double friction_slope(double slip, double full) {
  return slip >= full ? 1 : slip / full * (2 - slip / full);
}
double friction_curvature(double slip, double full) {
  return slip >= full ? 0 : 2 / full * (1 - slip / full);
}

}  // namespace

LockstepContact::LockstepContact(const LockstepModel& model)
    : model_(model),
      finder_(model.point_count(), model.cords, static_cast<int>(model.skin_weights.size()), model.skin) {
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
    Pair pair{kind, s.v, 0, 0, false};
    // One side may be the prop; the other, or both, are cords.
    int first = s.v[0], second = s.v[at(split)];
    pair.with_prop = first >= points || second >= points;
    if (first >= points) std::swap(first, second);
    const auto passes = [&](int v) { return v < points && !let_through_.empty() && let_through_[at(v)] != 0; };
    if (pair.with_prop && std::any_of(s.v.begin(), s.v.end(), passes)) continue;
    const CordSystem& a = model_.cords_of(first);
    if (pair.with_prop) {
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

void LockstepContact::find(std::span<const Vec3> x, std::span<const Vec3> dx) {
  model_.spread(x, from_);
  model_.spread(dx, way_);
  const std::size_t points = at(model_.point_count());
  const BoxFrame frame = frame_around(std::span(from_).first(points), std::span(way_).first(points), widest_reach_);
  boxes_.clear();
  for (std::size_t i = 0; i < from_.size(); ++i)
    boxes_.push_back(frame.swept(from_[i], from_[i] + way_[i], 0.5 * widest_reach_));
  finder_.arrange(from_);
  PairList found;
  finder_.find(boxes_, self_, found);
  pairs_.clear();
  push_pairs(found, PairKind::k_vertex_face);
  push_pairs(found, PairKind::k_edge_edge);
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
    if (!pair.with_prop) return false;
    const auto x = corners(pair, from_);
    return pair_geometry(pair.kind, x).distance < pair.reach + largest_relative_motion(pair.kind, corners(pair, way_));
  });
}

double LockstepContact::value(std::span<const Vec3> x) const {
  model_.spread(x, places_);
  double sum = 0;
  for (const Pair& pair : pairs_) {
    const auto corner = corners(pair, places_);
    if (box_gap_squared(pair.kind, corner) >= pair.reach * pair.reach) continue;
    const double d = pair_geometry(pair.kind, corner).distance;
    smallest_gap_ = std::min(smallest_gap_, d);
    sum += barrier(d, pair.reach, model_.contact_stiffness).energy;
  }
  for (const Slide& s : slides_) sum += s.limit * friction_energy(slip(s, x).norm(), sliding_);
  return sum;
}

NodeTerm LockstepContact::combination(const Pair& pair, const PairGeometry& geometry) const {
  NodeTerm out;
  for (std::size_t k = 0; k < 4; ++k)
    if (geometry.weight[k] != 0) model_.add_place(pair.v[k], geometry.weight[k], out);
  return out;
}

void LockstepContact::add_terms(std::span<const Vec3> x, std::vector<NodeTerm>& out, double far) const {
  model_.spread(x, places_);
  for (const Pair& pair : pairs_) {
    const auto corner = corners(pair, places_);
    if (box_gap_squared(pair.kind, corner) >= pair.reach * pair.reach) continue;
    const PairGeometry geometry = pair_geometry(pair.kind, corner);
    smallest_gap_ = std::min(smallest_gap_, geometry.distance);
    if (geometry.distance >= pair.reach || geometry.distance <= 0) continue;
    const Barrier b = barrier(geometry.distance, pair.reach, model_.contact_stiffness);
    NodeTerm& term = out.emplace_back(combination(pair, geometry));
    term.force = b.slope * geometry.normal;
    term.stiffness = b.curvature * geometry.normal * geometry.normal.transpose();
  }
  for (const Slide& s : slides_) {
    const Vec3 u = slip(s, x);
    const double size = u.norm();
    const double secant = size > 0 ? friction_slope(size, sliding_) / size : 2 / sliding_;
    NodeTerm& term = out.emplace_back(s.of);
    term.force = s.limit * secant * u;
    term.stiffness = s.limit * secant * s.across;
    if (size > 0 && far < k_near * sliding_) {
      const Vec3 along = u / size;
      term.stiffness -= s.limit * (secant - friction_curvature(size, sliding_)) * along * along.transpose();
    }
  }
}

Vec3 LockstepContact::slip(const Slide& slide, std::span<const Vec3> x) const {
  Vec3 u = Vec3::Zero();
  for (int k = 0; k < slide.of.count; ++k)
    u += slide.of.weight[at(k)] * (x[at(slide.of.node[at(k)])] - slide_start_[at(slide.of.node[at(k)])]);
  return slide.across * u;
}

void LockstepContact::lag_friction(std::span<const Vec3> x, std::span<const Vec3> x_t0, double h) {
  slides_.clear();
  slide_start_.assign(x_t0.begin(), x_t0.end());
  sliding_ = k_sliding_speed * h;
  model_.spread(x, places_);
  for (const Pair& pair : pairs_) {
    if (pair.friction <= 0) continue;
    const auto corner = corners(pair, places_);
    if (box_gap_squared(pair.kind, corner) >= pair.reach * pair.reach) continue;
    const PairGeometry g = pair_geometry(pair.kind, corner);
    if (g.distance >= pair.reach || g.distance <= 0) continue;
    Slide& s = slides_.emplace_back();
    s.of = combination(pair, g);
    s.across = Mat3::Identity() - g.normal * g.normal.transpose();
    s.limit = -pair.friction * barrier(g.distance, pair.reach, model_.contact_stiffness).slope;
  }
}

std::vector<Wrench> LockstepContact::on_prop(std::span<const Vec3> x) const {
  std::vector<Wrench> out(model_.setup.cords.size());
  std::vector<NodeTerm> terms;
  add_terms(x, terms);
  const int points = model_.point_count();
  for (const NodeTerm& t : terms) {
    int system = -1;
    for (int k = 0; k < t.count; ++k)
      if (t.node[at(k)] < points) system = model_.system_of[at(t.node[at(k)])];
    for (int k = 0; k < t.count; ++k)
      if (t.node[at(k)] >= points) out[at(system)].add(x[at(t.node[at(k)])], -t.weight[at(k)] * t.force);
  }
  return out;
}

std::vector<int> LockstepContact::blocking(std::span<const Vec3> x) const {
  model_.spread(x, places_);
  double least = 1;  // of the reach
  std::vector<double> nearness(at(model_.point_count()), 1);
  for (const Pair& pair : pairs_) {
    if (!pair.with_prop) continue;
    const double near = pair_geometry(pair.kind, corners(pair, places_)).distance / pair.reach;
    for (const int v : pair.v)
      if (v < model_.point_count()) nearness[at(v)] = std::min(nearness[at(v)], near);
    least = std::min(least, near);
  }
  std::vector<int> out;
  for (int v = 0; v < model_.point_count(); ++v)
    if (nearness[at(v)] < 1 && nearness[at(v)] <= k_hard * least) out.push_back(v);
  return out;
}

std::vector<char> LockstepContact::within_reach(std::span<const Vec3> x) {
  const std::vector<double> kept = std::exchange(let_through_, {});
  find(x, std::vector<Vec3>(x.size(), Vec3::Zero()));
  std::vector<char> out(at(model_.point_count()), 0);
  for (const Pair& pair : pairs_) {
    if (!pair.with_prop || pair_geometry(pair.kind, corners(pair, from_)).distance >= pair.reach) continue;
    for (const int v : pair.v)
      if (v < model_.point_count()) out[at(v)] = 1;
  }
  let_through_ = kept;
  return out;
}

std::vector<Crossing> LockstepContact::crossings(std::span<const Vec3> x) const {
  std::vector<Crossing> out;
  if (!model_.has_prop()) return out;
  model_.spread(x, places_);
  const TriangleTree tree(places_, model_.skin);
  for (const Triangle& cord : model_.cords) {
    const Vec3 &p = places_[at(cord[0])], &q = places_[at(cord[1])];
    tree.for_each_near(TreeBox::around(p.cwiseMin(q), p.cwiseMax(q)), [&](int index) {
      const Triangle& t = model_.skin[at(index)];
      if (edge_crosses_triangle(p, q, places_[at(t[0])], places_[at(t[1])], places_[at(t[2])]))
        out.push_back({{cord[0], cord[1]}, t, true});
    });
  }
  return out;
}

}  // namespace ft::inline solvers
