// Thousands of leaves blown about: thin plates in moving air (plate_aerodynamics.h), rigid, or with two ways in which
// they bend (leaf_bending.h) for those that are seen from near; kept out of moving bodies
// and the ground (leaf_contact.h, leaf_certificate.h), asleep where nothing moves them (leaf_sleep.h). One-way: nobody
// feels them.
//
// A frame is a few slices, at whose ends the wind and the bodies are known. In a slice a leaf flies on its own, in as
// many steps as it needs; near a body or a ground in short ones, each of which is flown, and corrected by impulses. So
// leaves depend on nothing but the scene, and any number of threads has the same bytes.
//
// On water (leaf_water.h) they float (leaf_float.h), and do not sleep.
//
// Leaves do not meet one another: in the air they pass through, and on the ground they lie over one another, each kept
// at a height of its own above what it lies on, so that no two are in one plane where they overlap.
#pragma once

#include <optional>

#include "baker/core/output_shape.h"
#include "solvers/base/solver.h"
#include "solvers/leaves/leaf_bending.h"
#include "solvers/leaves/leaf_bodies.h"
#include "solvers/leaves/leaf_float.h"
#include "solvers/leaves/leaf_shape.h"
#include "solvers/leaves/leaves_setup.h"

namespace ft::inline solvers {

struct ContactScratch;
struct ContactStep;

/// Blocks of its states, of all leaves in the setup's order: "x" centres of mass, "q" rotations (x, y, z, w), "v",
/// "spin" in world axes, "asleep" 1 or 0, "rest": for how long it has been at rest [s]; of leaves that bend "bent", the
/// modes of leaf_bending.h [rad], and "bending", their speeds [rad/s]; where there is water "afloat", as Afloat says.
///
/// A report's `own`: leaves_awake at the frame's end, leaves_lifted by the wind and leaves_woken by bodies in it,
/// leaves_brought_out by the certificate, leaves_fastest [m/s], leaf_steps of flight; where there is water
/// leaves_afloat. Its forces are those of awake leaves on each body and ground, peaks those of a slice; torques on a
/// ground are about the world's origin.
class LeavesSolver final : public Solver {
 public:
  /// Refuses, by a usage error, what makes no sense: a prototype without area, a leaf of none, masses that are not
  /// positive.
  static Result<std::unique_ptr<LeavesSolver>> make(LeavesSetup setup);

  int leaf_count() const { return static_cast<int>(leaves_.size()); }
  /// As many as there are leaves, in the setup's order.
  void leaf_states(const State& state, std::span<LeafState> out) const;
  /// The mesh to be instanced: the prototype's about its centre of mass.
  const LeafShape& shape(int prototype) const { return shapes_[at(prototype)]; }
  const PlateModel& plate(int leaf) const { return leaves_[at(leaf)].plate; }

  /// One system: instances of the prototypes' meshes about their centres of mass; of leaves that bend, one mesh of all.
  int system_count() const override { return 1; }
  const SystemShape* system_shape(int) const override { return setup_.bending > 0 ? nullptr : &instances_; }
  const Mesh& system_mesh(int) const override { return mesh_; }
  void system_positions(const State& state, int system, std::span<Vec3> positions) const override;
  void system_frame(const State& state, int system, FrameData& frame) const override;
  /// None: what leaves meet is others' to write.
  std::span<const Triangle> collider_triangles() const override { return {}; }
  void collider_positions(const State&, std::vector<Vec3>& positions) const override { positions.clear(); }
  State initial_state() const override;
  FrameReport advance_frame(State& state) override;

 private:
  /// What never changes of a leaf.
  struct Model {
    PlateModel plate;
    LeafShape shape;         ///< to scale
    double margin = 0;       ///< m
    double mass_factor = 1;  ///< 1
    std::optional<LeafBending> bending;
    FloatingPlate floating;
  };
  struct Moving {
    Vec3 x = Vec3::Zero(), v = Vec3::Zero(), spin = Vec3::Zero();
    Quat q = Quat::Identity();
    Modes bent = Modes::Zero(), bending = Modes::Zero();  ///< and its speed; of leaves that bend
    Afloat afloat = Afloat::k_no;
  };
  static bool floats(const Moving& m) { return m.afloat != Afloat::k_no; }
  static FloatingMotion floating(const Moving& m) { return {m.x, m.v, m.spin, m.q}; }
  struct Frame;
  struct Tally;
  struct Touch;

  explicit LeavesSolver(LeavesSetup setup);
  /// Of leaf i in a state, and back into it.
  Moving moving(const State& state, std::size_t i) const;
  /// Its vertices in the world [m].
  static void place_leaf(const Model& model, const Moving& m, std::vector<Vec3>& out);
  /// Of its modes, near something; directions of bending into the scratch.
  static BendingStep step_modes(const Model& model, const PlateAir& air, double time, const Moving& m,
                                ContactScratch& s);
  void add_forces(const Frame& frame, std::span<const Wrench> impulses, FrameReport& report) const;
  void wake(const Frame& frame, State& state, FrameReport& report) const;
  bool is_approached(const Vec3& place, double radius) const;
  /// Whether water has come up to a leaf, or stands over it.
  bool is_reached(const Model& model, const Moving& m) const;
  Tally advance_leaf(const Frame& frame, std::size_t leaf, Moving& moving, double& rest, double& asleep) const;
  int advance_slice(const Frame& frame, std::size_t leaf, int slice, Moving& moving, ContactScratch& scratch,
                    Touch& touch) const;
  double gap_to_water(const Model& model, const Moving& m, int slice, double from) const;
  int near_step(std::size_t leaf, const ContactStep& step, const PlateAir& air, Moving& moving, ContactScratch& scratch,
                Touch& touch) const;

  LeavesSetup setup_;
  std::vector<LeafShape> shapes_;  ///< of the prototypes
  std::vector<Model> leaves_;
  SystemShape instances_;
  Mesh mesh_;                    ///< of leaves that bend, as they are at the start
  double slowest_lift_off_ = 0;  ///< of all leaves [m/s]
  LeafBodies bodies_;            ///< scratch of a frame
  LeafWaters waters_;            ///< scratch of a frame
};

}  // namespace ft::inline solvers
