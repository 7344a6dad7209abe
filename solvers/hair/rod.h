// Discrete elastic rods: what never changes of a strand, or of four of them at once, and its potential.
//
// A strand has n vertices. Vertex 0 is a ghost below the root, vertex 1 the root; both, and the director of the edge
// between them, are given. Of the vertex at the root counts the half cell that is outside: so the droop of a clamped
// strand is right with few vertices. Unknowns, vertex by vertex: position, and turn of the director of the edge that
// starts there: 4 n - 1, of which the first 7 are given. Turns have no inertia.
//
//   E = sum EA/(2 l) (|e| - l)^2 + B/(2 v) ((k1 - k1r)^2 + (k2 - k2r)^2) + C/(2 v) (tw - twr)^2
#pragma once

#include <type_traits>
#include <vector>

#include "solvers/hair/banded_factor.h"
#include "solvers/hair/rod_stencil.h"

namespace ft::inline solvers {

inline constexpr int k_given = 7;  ///< unknowns that are given

template <class T>
struct Rod {
  int n = 0;
  std::vector<T> length;         ///< at rest, of edges 0 to n - 2 [m]
  std::vector<T> voronoi;        ///< length that belongs to a vertex, 1 to n - 2 [m]
  std::vector<T> mass;           ///< of vertices [kg]
  std::vector<T> k1, k2, tw;     ///< at rest, of vertices 1 to n - 2 [1]
  T stretch{}, bend{}, twist{};  ///< EA [N], EI and GJ [N m2]

  int unknowns() const { return 4 * n - 1; }
};

/// Where it is.
template <class T>
struct RodPose {
  std::vector<V3<T>> x;         ///< of vertices [m]
  std::vector<V3<T>> director;  ///< of edges, unit and square to them
};

/// Damping of strains: as if stiffness were larger by rate / time towards the strains of `since`.
template <class T>
struct RodStrains {
  std::vector<T> stretched, k1, k2, tw;  ///< lengths of edges [m]; strains of vertices
};
template <class T>
void strains_of(const RodPose<T>& pose, RodStrains<T>& out);

/// What of the Hessian is wanted.
template <class T>
struct RodHessian {
  T full =
      all_lanes<T>(1);  ///< 1: with second derivatives of strains; 0: Gauss and Newton's, which is never indefinite
  /// Tensions for the geometric stiffness, of edges [N]: those that a linear step before has foretold.
  const std::vector<T>* tension = nullptr;
};

/// Adds the potential's gradient and Hessian; returns the potential [J]. damping: of strains, time constant by the
/// step's time [1]; 0 without.
template <class T>
T add_potential(const Rod<T>& rod, const RodPose<T>& pose, const std::type_identity_t<RodStrains<T>>* since,
                double damping, const RodHessian<T>& wanted, std::vector<T>& gradient,
                std::type_identity_t<BandedMatrix<T>>* hessian);

/// The potential alone.
template <class T>
T potential(const Rod<T>& rod, const RodPose<T>& pose, const std::type_identity_t<RodStrains<T>>* since,
            double damping);

/// Moves it on by `share` of a step in its unknowns; directors go along with their edges and are turned.
template <class T>
void move_pose(const std::vector<T>& step, const T& share, const RodPose<T>& from, RodPose<T>& to);

/// An edge's director where its edge now points elsewhere.
template <class T>
V3<T> carried_director(const V3<T>& director, const V3<T>& before, const V3<T>& now);

}  // namespace ft::inline solvers
