// Contact of cords with the prop and with the scenery, and among cords that ask for it. Barrier of incremental
// potential contact (Li et al. 2020): b(d) = -k (d - r)^2 ln(d / r) below the reach r, which is twice a cord's radius;
// friction with normal force, direction and closest points of when it was last looked at. Forces on the two sides are
// equal and opposite to the last bit of the weights, which sum to 0. Scenery is where `share` of its way in the step
// has brought it [1]: it is driven, and a step is over when that is 1.
//
// What meets scenery hardly bounces: contact has a dashpot against approach, in proportion to its lagged normal force
// (Hunt and Crossley 1975).
#pragma once

#include <span>
#include <vector>

#include "baker/core/wrench.h"
#include "collision/broad_phase/pair_finder.h"
#include "collision/check/crossings.h"
#include "collision/geometry/pair_geometry.h"
#include "solvers/lockstep/lockstep_model.h"
#include "solvers/lockstep/near_scenery.h"

namespace ft::inline solvers {

class LockstepContact {
 public:
  explicit LockstepContact(const LockstepModel& model);

  /// What goes its way whatever stands in it: the scenery that moves, and the prop while it is driven.
  struct Blocked {
    int point = 0, met = 0;  ///< met: as LockstepModel numbers what is met
  };

  /// Per point what it may pass through, with all cords that end at it: sums of met_bit().
  void let_through(std::span<const double> points) { let_through_.assign(points.begin(), points.end()); }
  /// Before the first step of a frame: nothing that was before decides anything.
  void begin_frame() { near_.forget(); }
  /// Takes over a step, from t0 to t1 [s].
  void begin_step(double t0, double t1);
  /// Lists all pairs that can be within reach while the nodes go from x straight to x + dx, and the scenery from a
  /// share of its way to its end.
  void find(std::span<const Vec3> x, std::span<const Vec3> dx, double share = 1);
  /// Share of the way of the last find() that keeps everything apart, in (0, 1].
  double free_share() const;
  /// Whether anything of the last find() comes within reach of the prop on its way.
  bool meets_prop() const;
  /// Largest way in the step of scenery that is near, as of the last find() [m].
  double scenery_way() const { return near_.largest_way(); }

  double value(std::span<const Vec3> x, double share = 1) const;
  /// far: how far from rest x may still be [m]. Far from it the stiffness of friction is its secant, which is never
  /// less than what friction does on the way; near it the tangent, which converges faster.
  void add_terms(std::span<const Vec3> x, std::vector<NodeTerm>& out, double far = 0, double share = 1) const;
  /// Friction from now on acts with the normal forces of x, against motion since x_t0, and the step's start, in a step
  /// of h [s].
  void lag_friction(std::span<const Vec3> x, std::span<const Vec3> x_t0, double h, double share = 1);

  /// Largest speed of approach to scenery, of the contacts of that look, that the step from velocities v_t0 to x has
  /// taken away [m/s].
  double fastest_stop(std::span<const Vec3> x, std::span<const Vec3> v_t0, double share) const;
  /// Anything, or a dashpot, at the last look at friction.
  bool has_friction() const { return !slides_.empty(); }

  double smallest_gap() const { return smallest_gap_; }  ///< of all places that value() and add_terms() saw [m]
  void forget_gap();
  double widest_reach() const { return widest_reach_; }
  /// Per cord system, and of each per what is met: what it does to it at x; about the origin.
  std::vector<Wrench> on_met(std::span<const Vec3> x, double share = 1) const;
  /// Points of the cords that stand in the way of what is driven at x: those that are pressed hardest against it.
  std::vector<Blocked> blocking(std::span<const Vec3> x, bool prop_is_driven, double share) const;
  /// Per point what it is within reach of at x, at the end of the step, or what a cord of it crosses: sums of
  /// met_bit(), whether or not it may pass through that.
  std::vector<std::uint64_t> near_at(std::span<const Vec3> x);
  /// Edge-triangle crossings of cords with what they meet at x, at the end of the step, exact.
  struct MetCrossing {
    Edge cord;
    int met = 0;
  };
  std::vector<MetCrossing> crossings(std::span<const Vec3> x);

 private:
  struct Pair {
    PairKind kind;
    std::array<int, 4> v;
    double reach, friction;
    int met;  ///< k_own: of two cords
  };
  struct Slide {
    NodeTerm of;   ///< node and weight; force and stiffness unused
    Mat3 across;   ///< takes the part along the normal away
    double limit;  ///< friction times normal force [N]
    Vec3 normal;
    double dashpot;  ///< against approach [N s/m]
    int met;
    Vec3 given;  ///< slip that the whole way of the scenery makes [m]
  };
  static constexpr int k_own = -1;
  template <class Visit>
  void for_each_term(std::span<const Vec3> x, double far, double share, Visit&& visit) const;
  void spread(std::span<const Vec3> x, double share, std::vector<Vec3>& places) const;
  Vec3 given(const Pair& pair, const PairGeometry& geometry) const;
  void push_pairs(const PairList& from, PairKind kind);
  void push_scenery_pairs(const PairList& from, PairKind kind);
  bool passes(const std::array<int, 4>& v, int met) const;
  std::array<Vec3, 4> corners(const Pair& pair, std::span<const Vec3> places) const;
  NodeTerm combination(const Pair& pair, const PairGeometry& geometry) const;
  Vec3 moved(const Slide& slide, std::span<const Vec3> x, double share) const;

  const LockstepModel& model_;
  PairFinder finder_;
  Scenery scenery_;
  NearScenery near_;
  bool self_ = false;
  double widest_reach_ = 0;
  std::vector<double> let_through_;  ///< empty: none
  std::vector<Pair> pairs_;
  std::vector<Slide> slides_;
  std::vector<Vec3> slide_start_;  ///< of the nodes
  double sliding_ = 0;             ///< slip below which friction is not yet full [m]
  double h_ = 0;                   ///< of the step [s]
  std::vector<Vec3> from_, way_;   ///< of the last find(), second numbering
  mutable std::vector<Vec3> places_;
  mutable double smallest_gap_ = 0;
  std::vector<VertexBox> boxes_;
};

}  // namespace ft::inline solvers
