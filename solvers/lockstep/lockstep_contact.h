// Contact between cords and the prop, and among cords that ask for it. Barrier of incremental potential contact
// (Li et al. 2020): b(d) = -k (d - r)^2 ln(d / r) below the reach r, which is twice a cord's radius; friction with
// normal force, direction and closest points of when it was last looked at. Forces on the two sides are equal and
// opposite to the last bit of the weights, which sum to 0.
#pragma once

#include <span>
#include <vector>

#include "baker/core/wrench.h"
#include "collision/broad_phase/pair_finder.h"
#include "collision/check/crossings.h"
#include "collision/geometry/pair_geometry.h"
#include "solvers/lockstep/lockstep_model.h"

namespace ft::inline solvers {

class LockstepContact {
 public:
  explicit LockstepContact(const LockstepModel& model);

  /// Per point: not 0 where it may pass through the prop, with all cords that end at it.
  void let_through(std::span<const double> points) { let_through_.assign(points.begin(), points.end()); }
  /// Lists all pairs that can be within reach while the nodes go from x straight to x + dx.
  void find(std::span<const Vec3> x, std::span<const Vec3> dx);
  /// Share of the way of the last find() that keeps everything apart, in (0, 1].
  double free_share() const;
  /// Whether anything of the last find() comes within reach of the prop on its way.
  bool meets_prop() const;

  double value(std::span<const Vec3> x) const;
  /// far: how far from rest x may still be [m]. Far from it the stiffness of friction is its secant, which is never
  /// less than what friction does on the way; near it the tangent, which converges faster.
  void add_terms(std::span<const Vec3> x, std::vector<NodeTerm>& out, double far = 0) const;
  /// Friction from now on acts with the normal forces of x, against motion since x_t0 in a step of h [s].
  void lag_friction(std::span<const Vec3> x, std::span<const Vec3> x_t0, double h);

  bool rubs() const { return !slides_.empty(); }  ///< anything, at the last look at friction

  double smallest_gap() const { return smallest_gap_; }  ///< of all places that value() and add_terms() saw [m]
  void forget_gap();
  double widest_reach() const { return widest_reach_; }
  /// Per cord system: what it does to the prop at x; about the origin.
  std::vector<Wrench> on_prop(std::span<const Vec3> x) const;
  /// Points of the cords that stand in the prop's way at x: those that are pressed hardest against it.
  std::vector<int> blocking(std::span<const Vec3> x) const;
  /// Points of cords within reach of the prop at x, whether or not they may pass through it.
  std::vector<char> within_reach(std::span<const Vec3> x);
  /// Edge-triangle crossings of cords with the prop at x, exact.
  std::vector<Crossing> crossings(std::span<const Vec3> x) const;

 private:
  struct Pair {
    PairKind kind;
    std::array<int, 4> v;
    double reach, friction;
    bool with_prop;
  };
  struct Slide {
    NodeTerm of;   ///< node and weight; force and stiffness unused
    Mat3 across;   ///< takes the part along the normal away
    double limit;  ///< friction times normal force [N]
  };
  void push_pairs(const PairList& from, PairKind kind);
  std::array<Vec3, 4> corners(const Pair& pair, std::span<const Vec3> places) const;
  NodeTerm combination(const Pair& pair, const PairGeometry& geometry) const;
  Vec3 slip(const Slide& slide, std::span<const Vec3> x) const;

  const LockstepModel& model_;
  PairFinder finder_;
  bool self_ = false;
  double widest_reach_ = 0;
  std::vector<double> let_through_;  ///< empty: none
  std::vector<Pair> pairs_;
  std::vector<Slide> slides_;
  std::vector<Vec3> slide_start_;  ///< of the nodes
  double sliding_ = 0;             ///< slip below which friction is not yet full [m]
  std::vector<Vec3> from_, way_;   ///< of the last find(), second numbering
  mutable std::vector<Vec3> places_;
  mutable double smallest_gap_ = 0;
  std::vector<VertexBox> boxes_;
};

}  // namespace ft::inline solvers
