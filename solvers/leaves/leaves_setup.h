// What a shot says of its leaves, and how they are read from a state. See leaves_solver.h for what the solver does.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "baker/core/trajectory.h"
#include "baker/core/types.h"
#include "baker/core/vertex_flow.h"
#include "solvers/leaves/plate_aerodynamics.h"
#include "solvers/wind/wind.h"

namespace ft::inline solvers {

/// The shape that many leaves have in common, at scale 1: two flat panels that rise from the rib. Axes: x along the
/// rib, y up, z across; anywhere, the solver takes it to its centre of mass.
struct LeafPrototype {
  std::string name;
  std::vector<Vec3> positions;  ///< m, 3 to 64; triangles cover it once
  std::vector<Triangle> triangles;
  double mass_per_area = 0.08;  ///< kg/m2. 0.08 dry oak (Meir 2002), 0.16 to 0.24 fresh; > 0
  double fold = 0;              ///< by which each panel rises from the rib [rad], as in positions; 0 flat, 0.2 usual
  bool strip = false;           ///< added mass of an endless strip along x, for comparison with two dimensions
  PlateCoefficients law;        ///< of the air
  /// A lying leaf: lift by the air that is drawn from below it and drag, by dynamic pressure [1]. 0.08 lets a dry leaf
  /// go at 3.5 m/s, where leaves on the ground begin to move (Beaufort 3).
  double lying_lift = 0.08, lying_drag = 0.01;
  double adhesion = 0.1;  ///< holds a lying leaf [N/m2]. 0.1 dry, 2 to 5 wet; by its own weight it has 0.8
};

/// An almond of two panels with the rib between them: 3 stations + 2 tips, 11 vertices and more. length: of the rib,
/// width: across both panels when flat [m]; fold as in LeafPrototype; stations: between the tips, 2 to 12.
LeafPrototype almond_leaf(std::string name, double length, double width, double fold, int stations = 5);

struct Leaf {
  int id = 0;                           ///< as caches know it; any, each once
  int prototype = 0;                    ///< into LeavesSetup::prototypes
  Vec3 position = Vec3::Zero();         ///< of its centre of mass at the start [m]
  Quat orientation = Quat::Identity();  ///< prototype to world; the identity lies level
  double scale = 1;                     ///< of the prototype's lengths, > 0
  bool asleep = false;                  ///< lies where it is until something moves it
};

/// What leaves meet and do not move: a character, a prop, a ground. Closed surfaces have an inside; of others the
/// inside is where their triangles do not face.
struct LeafObstacle {
  std::string name;
  std::shared_ptr<const Trajectory> trajectory;
  double friction = 0.5;  ///< Coulomb [1]
  bool fixed = false;     ///< it stands still in the whole shot
};

/// The surface of a liquid on which leaves float: vertices over a grid in x and z (leaf_water.h). Where it is dry it
/// lies below the ground.
struct LeafWater {
  std::string name;
  std::shared_ptr<const Trajectory> surface;
  std::shared_ptr<const VertexFlow> flow{};  ///< null: it flows nowhere
};

/// All that is below a height.
struct LeafGround {
  double height = 0;      ///< m
  double friction = 0.5;  ///< Coulomb [1]
  std::string name{};
};

struct LeavesSetup {
  std::string name = "leaves";
  int first_frame = 1;
  double fps = 24;
  int preroll_frames = 0;
  Vec3 gravity = Vec3(0, -k_gravity, 0);  ///< m/s2
  double air_density = 1.225;             ///< kg/m3, > 0
  std::shared_ptr<const Wind> wind;       ///< null: still air
  std::uint64_t seed = 1;
  double mass_variation = 0.2;  ///< masses are (1 +- this) of the prototype's, evenly; 0 to 0.9 [1]
  bool may_sleep = true;        ///< false: for tests of resting leaves
  /// Bending stiffness of leaves that bend, which are a mesh in the caches [N m]; 0: they are rigid, and instances.
  double bending = 0;
  std::vector<LeafPrototype> prototypes;
  std::vector<Leaf> leaves;  ///< their number never changes
  std::vector<LeafObstacle> bodies;
  std::vector<LeafGround> grounds;
  std::vector<LeafWater> waters{};
};

/// Of one leaf, for caches of instances.
struct LeafState {
  int id = 0, prototype = 0;
  double scale = 1;
  Vec3 position = Vec3::Zero();          ///< of the centre of mass [m]
  Quat orientation = Quat::Identity();   ///< prototype (about its centre of mass) to world
  Vec3 velocity = Vec3::Zero();          ///< m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< world axes [rad/s]
  bool asleep = false;
  bool afloat = false;
};

}  // namespace ft::inline solvers
