// The potential of cords and of the prop's frame, but for inertia and contact:
//   stretching  1/2 k max(0, l - L)^2, for springs that push too 1/2 k (l - L)^2
//   damping     of stretching, implicit: 1/2 (c / t) (e - e_0)^2 while the cord is taut. A cord never pushes, so both
//               together are one spring: stiffness k + c/t, longer by what damping holds back
//   bending     1/2 (B / l^3) |x_0 - 2 x_1 + x_2|^2 along a strand that rests straight; damped like stretching
//   holds       1/2 k |x - p|^2
//   air         drag across a cord, 1/2 rho C_d d |v_n| v_n per length, with the speed of the step's start
#pragma once

#include <span>
#include <vector>

#include "solvers/lockstep/node_system.h"
#include "solvers/wind/wind.h"

namespace ft::inline solvers {

struct CordSpring {
  int a = 0, b = 0;
  double length = 0;     ///< at rest [m], > 0
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
  bool pushes = false;
};

/// Evenly spaced points of a strand.
struct CordBend {
  std::array<int, 3> node{};
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
};

struct CordDrag {
  int a = 0, b = 0;
  double area = 0;  ///< length times diameter [m2]
};

struct Air {
  double density = 0;                  ///< kg/m3
  std::shared_ptr<const Wind> wind{};  ///< null: it stands still
};

struct CordHold {
  int node = 0;
  Vec3 place = Vec3::Zero();  ///< m
  double stiffness = 0;       ///< N/m
};

struct CordElements {
  std::vector<CordSpring> springs;
  std::vector<CordBend> bends;
  std::vector<CordHold> holds;
  std::vector<CordDrag> drags;
  Air air;

  /// Takes over the step: when it ends, its length [s], positions and velocities at its start.
  void begin_step(double end, double h, std::span<const Vec3> x_t0, std::span<const Vec3> v_t0);
  double value(std::span<const Vec3> x) const;  ///< J
  void add_terms(std::span<const Vec3> x, std::vector<NodeTerm>& out) const;
  Vec3 hold_force(std::span<const Vec3> x) const;  ///< of all holds on their nodes [N]

 private:
  struct Now {
    double length, stiffness;  ///< with damping
  };
  /// c |x_a + x_b - goal|^2 / 8 across the cord: drag on its middle.
  struct DragNow {
    Mat3 stiffness;
    Vec3 goal;
  };
  Vec3 bend_of(const CordBend& b, std::span<const Vec3> x) const {
    return x[at(b.node[0])] - 2 * x[at(b.node[1])] + x[at(b.node[2])];
  }
  std::vector<Now> now_;
  std::vector<Vec3> bent_;  ///< per bend, at the step's start
  std::vector<DragNow> drag_;
  double h_ = 0;
};

}  // namespace ft::inline solvers
