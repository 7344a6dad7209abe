// One implicit step of four strands: Newton's method with the tension carried along.
//
// Hair is a million times stiffer along than across, so that Newton's method on positions alone crawls: it sees the
// tension of the present iterate in the geometric stiffness. With the tension that the last linear step has foretold
// it is Newton's method on positions and tensions together, the tensions eliminated, and takes three to six iterations
// whatever the stiffness. The full Hessian is used while it is positive definite, strand by strand; else Gauss and
// Newton's.
#pragma once

#include "solvers/hair/rod.h"

namespace ft::inline solvers {

/// A plane in the way of a vertex, of the body as it is at the step's end.
template <class T>
struct HairContact {
  V3<T> normal;   ///< unit, out of the body; zero: there is none
  T offset{};     ///< of the plane: normal . x = offset on it [m]
  T reach{};      ///< gap below which it pushes [m], > 0
  T stiffness{};  ///< N/m
  V3<T> carried;  ///< where the vertex would be if it went along with the body [m]
  T friction{};   ///< Coulomb [1]
  T drag{};       ///< scratch: friction's stiffness across, frozen [N/m]
};
/// The same for a point of a segment, without friction.
template <class T>
struct SegmentContact {
  V3<T> normal;
  T share{};  ///< where on the segment, from its first end [1]
  T offset{}, reach{}, stiffness{};
};
/// Force along the normal [N], its slope, positive [N/m], and its energy [J], at a gap d below the reach r: k (r - d)
/// down to r/2, k r^2 / (4 d) down to r/8, so that what presses harder is held nearer but out, and straight on from
/// there, so that what is inside is pushed out. At the surface it is 4 k r; a contact that this does not hold becomes
/// stiffer during the step, as long as it would not stretch the strand.
template <class T>
void contact_force(const T& gap, const T& reach, const T& stiffness, T& force, T& slope, T& energy);

inline constexpr int k_contacts = 3;  ///< of a vertex, at most
/// Of a segment: with what is near at the start of a step, and where it would have gone through a sheet in it.
inline constexpr int k_near_contacts = 2, k_passages = 4, k_segment_contacts = k_near_contacts + k_passages;

/// What is around four strands in a step.
template <class T>
struct RodSurroundings {
  std::vector<T> pull;                      ///< of inertia, drag and gravity together: pull/2 |x - goal|^2 [N/m]
  std::vector<V3<T>> goal;                  ///< m
  std::vector<HairContact<T>> contacts;     ///< k_contacts for each vertex; empty: none
  std::vector<SegmentContact<T>> segments;  ///< k_segment_contacts for each vertex: of the segment before it
  bool touches = false;                     ///< whether any is there
  double friction_speed_way = 0;            ///< way in the step below which friction is viscous [m]
};

struct RodStepReport {
  int iterations = 0;
  bool settled[k_lanes] = {true, true, true, true};
};

template <class T>
class RodStep {
 public:
  /// pose: first guess, with the given unknowns where they are at the end; where it settles. tension: of edges, carried
  /// from step to step [N]. since: strains at the start, damped by `damping`.
  RodStepReport run(const Rod<T>& rod, RodSurroundings<T>& around, const RodStrains<T>& since, double damping,
                    std::vector<T>& tension, RodPose<T>& pose);
  /// A vertex that moves by less is settled [m].
  double tolerance = 1e-5;
  int most_iterations = 40;

 private:
  T contacts_of_segments(const RodSurroundings<T>& around, const RodPose<T>& pose, bool derivatives);
  T surroundings(const RodSurroundings<T>& around, const RodPose<T>& pose, bool derivatives);
  void freeze_friction(RodSurroundings<T>& around, const RodPose<T>& pose) const;
  T stiffen_pierced(const Rod<T>& rod, RodSurroundings<T>& around, const RodPose<T>& pose, const T& who) const;
  void assemble(const Rod<T>& rod, const RodSurroundings<T>& around, const RodStrains<T>& since, double damping,
                const std::vector<T>& tension, const RodPose<T>& pose, const T& full);

  std::vector<T> gradient_, step_;
  BandedMatrix<T> hessian_;
  RodPose<T> trial_;
  T energy_{};
};

}  // namespace ft::inline solvers
