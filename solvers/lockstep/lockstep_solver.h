// Nets, ropes and one rigid prop in one system, stepped in lock step: what a cord does to the prop, the prop does to
// the cord. The potential is inertia + stretching + bending + holds + contact + friction; Newton with a direct sparse
// factorisation solves it to rounding, so cords need no iterations and momentum is kept. The prop may be driven along
// a track (one-way, and hybrid with an adjusted track) or move by itself once it is released (two-way).
//
// Sources: affine body dynamics (Lan et al. 2022) with an equimomental tetrahedron for the prop, incremental potential
// contact (Li et al. 2020) with lagged friction, BDF2.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/rigid.h"
#include "solvers/base/solver.h"
#include "solvers/cords/cord_graph.h"

namespace ft::inline solvers {

/// A net, a rope, a chain of knots.
struct CordSystem {
  std::string name;
  CordGraph graph;
  double mass = 0.03;           ///< of all cords together [kg], > 0
  double stretch = 3000;        ///< EA: force that would double a cord's length [N], > 0
  double bend = 0;              ///< EI along strands that rest straight there [N m2]
  double damping = 1e-3;        ///< of stretching, times its stiffness [s]
  double radius = 1.5e-3;       ///< of the cord [m]; contact begins at twice as much from the middle
  double friction = 0.4;        ///< Coulomb [1]
  double hold_stiffness = 2e4;  ///< of the springs that tie held points to the world [N/m]
  bool self_collision = false;
};

struct RigidProp {
  std::string name;
  std::vector<Vec3> surface;  ///< body axes, about the centre of mass [m]
  std::vector<Triangle> triangles;
  RigidMass mass;                                 ///< two-way: positive; else unused
  std::function<RigidMotion(double time)> track;  ///< s from the first frame of the shot, negative in the pre-roll
  bool two_way = false;
  double release = std::numeric_limits<double>::infinity();  ///< it moves by itself from then on [s]; two-way
  bool release_on_contact = false;                           ///< or from where something comes into reach
};

struct LockstepSetup {
  std::vector<CordSystem> cords;
  std::optional<RigidProp> prop;
  int first_frame = 1;
  double fps = 24;
  int preroll_frames = 24;
  Vec3 gravity = Vec3(0, -k_gravity, 0);  ///< m/s2
  Vec3 wind = Vec3::Zero();               ///< m/s
  double air_density = 1.225;             ///< drags at cords, not at the prop [kg/m3]; 0: vacuum
  double longest_step = 1.0 / 1200;       ///< s
  int min_substeps = 1;                   ///< of a frame, >= 1
  double settled = 1e-8;                  ///< Newton ends when nothing wants to move further [m]
  int most_halvings = 3;                  ///< of a step that does not settle, and of its halves
  bool bdf2 = true;                       ///< false: implicit Euler
};

/// Systems are the cords, as surfaces of tubes. The collider is the prop. Blocks of its states: "x", "v" and their
/// history of all cord points and then the prop's four nodes; "free": 1 once the prop is released; "hold_impulse":
/// what the held points were given so far [N s].
Result<std::unique_ptr<Solver>> make_lockstep_solver(LockstepSetup setup);

}  // namespace ft::inline solvers
