// What a cloth solver is made of: garments with their pins, the body that they meet, and how finely time is cut.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/result.h"
#include "baker/core/teleport.h"
#include "baker/core/trajectory.h"
#include "collision/body/feasible_poses.h"
#include "solvers/base/solver.h"
#include "solvers/cloth/model/cloth_settings.h"
#include "solvers/energies/cloth_topology.h"
#include "solvers/energies/hold_span.h"
#include "solvers/wind/wind.h"

namespace ft::inline solvers {

/// Vertices that are held to the body, each following the nearest point of the body's bind pose; or to a garment, each
/// hanging on the nearest point of its surface by a cord, see attach.h.
struct ClothPin : ClothPinSettings {
  std::vector<int> vertices;    ///< garment's file order
  std::vector<double> weights;  ///< 0..1 each, scales the stiffness; empty: all 1
  HoldSpan hold{};              ///< when
  int to = -1;                  ///< garment of the setup, perhaps its own, which holds it; -1: the body
  bool to_world = false;        ///< holds where the mesh is; the garment then starts there, too
};

/// Parts of a primary that follow one another: those of one body, where it is several in one.
struct PartRange {
  int first_part = 0, part_count = 0;
  bool has(int part) const { return part >= first_part && part < first_part + part_count; }
};

struct ClothGarment : ClothSettings {
  std::string name;
  Mesh mesh;  ///< bind-pose placement, m; its positions are the rest shape unless pattern_scale says otherwise
  double pattern_scale = 0;  ///< m per unit of uvs, which are the rest shape then; 0: the positions are
  Fabric fabric;
  std::vector<ClothPin> pins;
  std::vector<int> ignores;  ///< parts of the primary that it does not meet
  /// Where the primary is several bodies in one: the parts of the body that wears it, and what takes it to where that
  /// starts. Without a value the primary is one body, and the garment starts with it.
  struct Wearer : PartRange {
    Eigen::Isometry3d to_start = Eigen::Isometry3d::Identity();
  };
  std::optional<Wearer> wearer;
  VertexMaps maps;  ///< one value per vertex of `mesh`, or empty
};

struct ClothSetup {
  std::vector<ClothGarment> garments;
  std::shared_ptr<const Trajectory> primary;  ///< may be null: cloth alone
  /// Where the primary is several bodies in one: which of its parts are whose. Forces are told of each. Empty: it is
  /// one.
  struct Body : PartRange {
    std::string name;
  };
  std::vector<Body> bodies;
  int first_frame = 1;
  double fps = 24;
  int preroll_frames = 24;
  Vec3 gravity = Vec3(0, -k_gravity, 0);    ///< m/s2
  std::shared_ptr<const Wind> wind;         ///< null: the air stands still
  double air_density = 1.225;               ///< kg/m3; 0: vacuum
  int min_substeps = 3, max_substeps = 32;  ///< a frame
  double travel = 5.5;  ///< most that the body goes against the cloth in a substep, in contact radii; 16 is coarse
  int newton_iterations = 3;
  double linear_tolerance = 1e-2;  ///< of the first linear solve of a step; later ones may leave as much
  /// A linear system of so many blocks and more, 4 MB, is freed when it is solved: what truncation needs is as large,
  /// and it is seldom asked for again. To have a smaller one freed and filled all the time costs more than it saves.
  std::size_t large_system = 100'000;
  /// What moves has edges this many times as long as the garments', 1..4; their vertices ride on it. For previews.
  double coarsen = 1;
  /// Edges that are absurdly short (coarse_garment.h) move like all others, and often blow up. For tests.
  bool keep_short_edges = false;
  bool bdf2 = true;  ///< with a quarter of BDF3; false: implicit Euler
  FeasibleSettings feasible;
  std::shared_ptr<FeasiblePoses> poses;  ///< of `primary` and `feasible`; null: the solver's own
  std::vector<Teleport> teleports;       ///< of the primary: the cloth goes along
};

/// As make_cloth_solver(); decorators make what they stand around with it.
using ClothSolverMaker = std::function<Result<std::unique_ptr<Solver>>(ClothSetup)>;

}  // namespace ft::inline solvers
