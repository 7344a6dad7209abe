// Hair and whatever grows: strands as discrete elastic rods (rod.h) among the scene's bodies, rooted in a scalp.
// One-way: nobody feels them.
//
// A frame is a number of equal steps, so many that no body goes farther than some millimetres in one. In a step, what
// is near each vertex at its start becomes up to three planes of the body as it is at its end, and what is near each
// segment to two (rod_step.h); four strands at a time are then solved by Newton's method (rod_step.h). BDF2, which
// keeps swings; a step that differs from the one before it begins anew with implicit Euler. What does not settle is
// done again in 2, 4 or 8 pieces; of a strand that went through a sheet, with planes where it did
// (sheet_passage.h). The groom is the equilibrium: rest_shape.h.
//
// Strands feel one another as a crowd, as it is at the start of a step (hair_crowd.h).
//
// Where the scalp jumps (HairSetup::teleports) there is no step: each strand goes with its root as it is.
//
// Drag is towards the motion of the root, as the difference formula of the step has it at the step's end, so that hair
// that falls together with its head is not braked; and towards the air by the square of the speed.
#pragma once

#include <optional>

#include "baker/core/output_shape.h"
#include "solvers/base/solver.h"
#include "solvers/hair/hair_bodies.h"
#include "solvers/hair/hair_crowd.h"
#include "solvers/hair/hair_roots.h"
#include "solvers/hair/hair_setup.h"
#include "solvers/hair/ridden_mesh.h"
#include "solvers/hair/rod_step.h"
#include "solvers/hair/strands_between.h"

namespace ft::inline solvers {

struct StrandNow;

/// What is inside of what it meets as it was combed, and may stay as deep.
struct CombedInside {
  int vertices = 0, segments = 0;  ///< segments: their middles, of those whose ends are outside
  double deepest = 0;              ///< m
};

/// Blocks of its states, of all strands in the setup's order, with the ghost vertex first: "x" and "v" now, "x_before"
/// and "v_before" a step before [m, m/s], "m" directors, "tension" [N], "step" the last step's length [s].
///
/// A report's `own`: hair_steps of the frame, 0 where its scalp jumps, hair_iterations in the mean of steps and groups,
/// hair_unsettled strands in steps. Its strains are |length / rest length - 1| of strands. inside_body counts vertices
/// that are inside of a body by more than they were combed, crossings_body those and segments whose middles are. Its
/// force is on the body that the roots are on, all that is no gravity and no air: what strands lie on elsewhere, too.
class HairSolver final : public Solver {
 public:
  /// Refuses, by a usage error, what makes no sense: strands of different numbers of vertices or of no length, roots
  /// far from the scalp, a material that is not positive.
  static Result<std::unique_ptr<HairSolver>> make(HairSetup setup);

  int strand_count() const { return static_cast<int>(setup_.strands.size()); }
  int vertices() const { return n_ - 1; }
  /// By how much each strand is stiffer than its material, so that it stands as it is combed [1].
  std::span<const double> stiffened() const { return stiffened_; }
  /// From the scalp [m].
  double farthest_root() const { return roots_->farthest(); }
  /// Of all hairs that the strands stand for [kg].
  double mass() const;
  CombedInside combed_inside() const;
  /// Segments that were combed through a sheet; what is tied does not count.
  int combed_through() const { return combed_through_; }

  /// The guides; what is between them and a mesh that rides on them, if there are such.
  int system_count() const override { return 1 + (between_ ? 1 : 0) + (ridden_ ? 1 : 0); }
  const SystemShape* system_shape(int system) const override {
    return system == 0 ? &shape_ : is_ridden(system) ? nullptr : &between_shape_;
  }
  const Mesh& system_mesh(int) const override { return setup_.ridden; }
  void system_positions(const State& state, int system, std::span<Vec3> positions) const override;
  void system_frame(const State& state, int system, FrameData& frame) const override;
  std::span<const Triangle> collider_triangles() const override { return {}; }
  void collider_positions(const State&, std::vector<Vec3>& positions) const override { positions.clear(); }
  State initial_state() const override;
  FrameReport advance_frame(State& state) override;

 private:
  struct Step;
  struct Piece;
  struct Work;

  explicit HairSolver(HairSetup setup);
  void measure_gaps();
  void make_groups();
  std::vector<RootFrame> roots_at(double time) const;
  void make_crowd();
  void feel_crowd(const State& state, double h, std::span<const RootFrame> roots, std::vector<Vec3>& push,
                  std::vector<Vec3>& flow);
  void stiffen_alike(std::vector<double>& factors) const;
  std::size_t strand_of(std::size_t group, int lane) const;
  void advance_group(const Step& step, std::size_t group, Work& work) const;
  void load(const Step& step, std::size_t group, Work& work) const;
  void store(const Step& step, std::size_t group, int lane, const StrandNow& now) const;
  void add_contacts(const Step& step, std::size_t group, int lane, Work& work) const;
  void add_segment_contact(std::size_t group, int lane, std::size_t vertex, const Vec3& before_goes, const Vec3& goes,
                           bool lies, Work& work) const;
  void put_segment_contact(std::size_t group, int lane, std::size_t vertex, int slot, const NearSurface& surface,
                           double share, const Vec3& a, const Vec3& b, Work& work) const;
  void solve_step(const Step& step, std::size_t group, std::array<bool, k_lanes> open, Work& work) const;
  int bar_passages(const Step& step, std::size_t group, int lane, int round, Work& work) const;
  RodStepReport run_piece(const Step& step, const Piece& piece, std::size_t group, Work& work) const;
  bool is_ridden(int system) const { return ridden_ && system == system_count() - 1; }
  bool jumps_into(int frame) const;
  void carry(State& state, std::span<const RootFrame> now, std::span<const RootFrame> after) const;
  void certify(const State& state, FrameReport& report) const;
  Wrench impulse_on_scalp(const State& state, double h, const AirNow* air) const;
  void add_force(std::span<const Wrench> impulses, double h, double time, FrameReport& report) const;

  HairSetup setup_;
  int n_ = 0;  ///< vertices of a strand, with its ghost
  std::unique_ptr<HairRoots> roots_;
  HairBodies bodies_;                     ///< scratch of a frame
  std::optional<HairCrowd> crowd_;        ///< none: strands do not feel one another
  std::vector<Rod<Lanes>> rods_;          ///< of four strands each, the last ones padded
  std::vector<std::vector<Vec3>> groom_;  ///< of each strand, with its ghost, in the bind pose [m]
  std::vector<Vec3> directors_;           ///< of all strands' edges, in the bind pose
  std::vector<double> gaps_;              ///< of each vertex as combed, to what it meets [m]
  std::vector<double> segment_gaps_;  ///< of the segment before each vertex, to sharp edges of it, or of its middle [m]
  int combed_through_ = 0;
  std::vector<double> lengths_, stiffened_;
  double hairs_ = 1;  ///< that a strand stands for
  SystemShape shape_, between_shape_;
  std::unique_ptr<StrandsBetween> between_;
  std::unique_ptr<RiddenMesh> ridden_;
};

}  // namespace ft::inline solvers
