// Nets, ropes and one rigid prop in one system, stepped in lock step: what a cord does to the prop, the prop does to
// the cord. Other bodies go their way, and cords meet them there. The potential is inertia + stretching + bending +
// holds + contact + friction; Newton with a direct sparse factorisation solves it to rounding, so cords need no
// iterations and momentum is kept. The prop may be driven along a track (one-way, and hybrid with an adjusted track) or
// move by itself once it is released (two-way).
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
#include "baker/core/trajectory.h"
#include "solvers/base/solver.h"
#include "solvers/cords/cord_graph.h"
#include "solvers/cords/cord_settings.h"
#include "solvers/wind/wind.h"

namespace ft::inline solvers {

/// A net, a rope, a chain of knots.
struct CordSystem : CordSettings {
  std::string name;
  CordGraph graph;
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

/// A body that pushes cords and does not feel them: a ground, a set, another prop, a character.
struct MetBody {
  std::string name;
  std::shared_ptr<const Trajectory> trajectory;
  bool fixed = false;        ///< it stands still in the whole shot
  std::vector<char> met_by;  ///< per cord system: not 0 where it meets the body
};

struct LockstepSetup {
  std::vector<CordSystem> cords;
  std::optional<RigidProp> prop;
  std::vector<MetBody> bodies;  ///< others that cords meet
  int first_frame = 1;
  double fps = 24;
  int preroll_frames = 24;
  Vec3 gravity = Vec3(0, -k_gravity, 0);  ///< m/s2
  std::shared_ptr<const Wind> wind;       ///< null: the air stands still
  double air_density = 1.225;             ///< drags at cords, not at the prop [kg/m3]; 0: vacuum
  double longest_step = 1.0 / 1200;       ///< s
  int min_substeps = 1;                   ///< of a frame, >= 1
  double settled = 1e-8;                  ///< Newton ends when nothing wants to move further [m]
  int most_halvings = 3;                  ///< of a step that does not settle, and of its halves
  bool bdf2 = true;                       ///< false: implicit Euler
};

/// Systems are the cords, as surfaces of tubes. The collider is the prop. Blocks of its states: "x", "v" and their
/// history of all cord points and then the prop's four nodes; "free": 1 once the prop is released; "through": per
/// point, what it is let through (met_bit() of each, added up); "hold_impulse": what the held points were given so far
/// [N s].
Result<std::unique_ptr<Solver>> make_lockstep_solver(LockstepSetup setup);

}  // namespace ft::inline solvers
