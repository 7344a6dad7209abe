// What the conductor knows of a solver: it starts, it advances one frame, it says what it did. Model and scratch live
// in the solver; everything that changes lives in State, so that a checkpoint is save(State) and nothing else.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/state.h"
#include "baker/core/wrench.h"

namespace ft {
struct FrameData;
struct SystemShape;
}  // namespace ft

namespace ft::inline solvers {

/// Something that a user should look at: where, when, how bad.
struct Incident {
  enum class Kind {
    k_crossing,
    k_penetration,
    k_released,
    k_strain,
    k_start_inside,
    k_rewind,
    k_unsettled,
    k_open_seam,
    k_cut_short
  };
  Kind kind = Kind::k_crossing;
  int frame = 0;
  std::string system;         ///< name of the garment
  int vertex = -1;            ///< of system_mesh(); in manifests, and of cords, of the cached mesh; from 0. Or instance
  Vec3 place = Vec3::Zero();  ///< m, world
  double depth = 0;           ///< m (or 1 for strain)
  std::string text;           ///< one sentence
};

const char* name(Incident::Kind kind);

/// Wall time of the phases of a frame [s]; for --profile and the log, never for a cache.
struct FrameProfile {
  double candidates = 0, narrow = 0, assembly = 0, linear = 0, certificate = 0, body = 0;
  double total = 0;  ///< of the frame: the phases and what lies between them

  FrameProfile& operator+=(const FrameProfile& other);
};

/// A phase as files and tables know it.
struct ProfilePhase {
  const char* key;
  const char* title;
  double FrameProfile::*time;
};

/// The one list of the phases; the total is not among them.
std::span<const ProfilePhase> profile_phases();

/// What one secondary did to a primary in one frame by contact, friction and pins, from its change of momentum. The
/// paper's measure of what a coupling has to carry.
struct InteractionForce {
  std::string system;        ///< name of the garment
  Wrench mean;               ///< over the frame; the torque about the primary's centre of volume at the frame's end
  double peak = 0;           ///< largest force of a piece of a substep [N]
  double contact_share = 0;  ///< of the frame, during which there was any force [1]
  std::string primary{};     ///< whose; empty: the secondary's own, and it meets no other
};

/// Vertices of the feasible collider that a system does not meet at a frame's end, as Solver::collider_absent.
struct AbsentRuns {
  std::string system;
  std::vector<std::array<int, 2>> runs;  ///< first vertex, and how many from there; ascending
  std::string collider{};                ///< the cached system with these vertices, where the system meets several
};

/// The certificate of one frame, and what it took.
struct FrameReport {
  int frame = 0;
  int substeps = 0, newton_iterations = 0, linear_iterations = 0, rewinds = 0;
  int crossings_body = 0;    ///< edge-triangle crossings with the feasible collider, exact
  int crossings_self = 0;    ///< edge-triangle crossings among the cloths, exact
  int crossings_drawn = 0;   ///< edge-triangle crossings with the drawn body
  double smallest_gap = 0;   ///< m, to the feasible collider and among cloths; the contact radius if nothing is nearer
  double deepest_drawn = 0;  ///< m, deepest cloth vertex inside the drawn body
  int inside_body = 0;       ///< vertices on the wrong side of the feasible collider's surface, where it is not absent
  int open_stitches = 0;     ///< stitches that are open after their seams should have closed
  double widest_seam = 0;    ///< m, of those
  double strain_p99 = 0, strain_max = 0, strain_mean = 0;  ///< edge strain, 1
  double kinetic_energy = 0;                               ///< J
  int absent_vertices = 0;   ///< of the collider that a garment does not meet, the most of any garment
  int crossings_absent = 0;  ///< edge-triangle crossings with what is absent for the cloth that crosses it
  /// Cords that were let through a part because there was no room; of the collider of cloth, vertices that were let go
  /// although no overlap of the body was known to be there.
  int released_vertices = 0;
  bool finite = true;
  std::map<std::string, double, std::less<>> own;  ///< metrics that only some kinds have, see frame_metrics.h
  std::vector<InteractionForce> forces;            ///< one of each garment, and of each primary that it meets
  std::vector<AbsentRuns> absent;                  ///< of the systems that do not meet all of the collider
  std::vector<Incident> incidents;                 ///< worst first, at most 16 a frame
  FrameProfile profile;
};

/// What happens before the pre-roll, where a garment starts wrong: the primary stands still while that is put right.
struct Settling {
  bool goes_on = false;  ///< more frames are wanted
  int frames = 0;        ///< so far
  int crossings = 0;     ///< among cloths, that were left after the last of them
};

class Solver {
 public:
  virtual ~Solver() = default;

  /// One system per cache: a garment, a rope, the leaves of a tree.
  virtual int system_count() const = 0;

  // A system is a mesh of constant topology, and then these two are all that a solver says of it;
  /// Its vertices and faces; what else a file says of them is not kept.
  virtual const Mesh& system_mesh(int system) const;
  /// Positions in the vertex order of system_mesh().
  virtual void system_positions(const State& state, int system, std::span<Vec3> positions) const;

  /// Of the surface of a liquid: how it flows at the vertices, for what floats on it and for the caches [m/s]; y: what
  /// it climbs along the slope, without how the surface rises. Zero unless it says so.
  virtual void surface_flow(const State& /*state*/, int /*system*/, std::span<Vec3> velocities) const {
    std::fill(velocities.begin(), velocities.end(), Vec3::Zero());
  }

  // or it has another shape, and then these two are (baker/core/output_shape.h, output_frame.h).
  /// Null: a mesh. Stays for as long as the solver does.
  virtual const SystemShape* system_shape(int /*system*/) const { return nullptr; }
  /// Fills a frame, which may hold an older one, with all that the shape's content asks for, velocities included:
  /// nobody takes differences of what is no mesh. Numbers of the elements never change where the shape lists their ids.
  virtual void system_frame(const State& state, int system, FrameData& frame) const;

  /// Of either: the name of its caches.
  const std::string& system_name(int system) const;

  /// Topology of the feasible collider, and its positions at the state's time.
  virtual std::span<const Triangle> collider_triangles() const = 0;
  virtual void collider_positions(const State& state, std::vector<Vec3>& positions) const = 0;
  /// Which vertices of the feasible collider a system does not meet at the state's time, nor any feature that one of
  /// them belongs to: 1, else 0. Empty: it meets all.
  virtual std::vector<char> collider_absent(const State& /*state*/, int /*system*/) const { return {}; }
  /// Whether the primary goes where the solver takes it, which is where the collider is; else along its trajectory.
  virtual bool moves_primary() const { return false; }

  /// State at the start of the pre-roll.
  virtual State initial_state() const = 0;
  /// Of a state, which knows it all through the shot.
  virtual Settling settling(const State&) const { return {}; }
  /// One frame with the primary as it is at the state's time; the state's frame and time stay. Only while settling()
  /// goes on.
  virtual FrameReport settle_frame(State&) { return {}; }
  /// From state.frame to state.frame + 1. Always returns with a finite state; what could not be kept is in the report.
  virtual FrameReport advance_frame(State& state) = 0;
};

}  // namespace ft::inline solvers
