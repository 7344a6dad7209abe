// What can meet in one piece of a substep: the pairs between carried cloth, body and cloth, and how far the body can
// advance before the first of them touches (conservative CCD over the carried motion). Pairs are collected in a frame
// that moves with the cloth's mean carry, so that a fast character does not sweep its boxes through everything.
#pragma once

#include <span>
#include <vector>

#include "collision/broad_phase/flat_patches.h"
#include "collision/broad_phase/pair_finder.h"
#include "collision/broad_phase/pair_runs.h"
#include "collision/geometry/pair_geometry.h"
#include "collision/step_bound/motion_zones.h"
#include "solvers/cloth/advance/approach_limits.h"
#include "solvers/cloth/advance/body_advance.h"
#include "solvers/cloth/model/piece_motion.h"
#include "solvers/cloth/solve/way_out.h"

namespace ft::inline solvers {

/// A cloth vertex that wants to leave its ball: where it is, where it wants to be, and what to add around [m].
struct RoomRequest {
  int vertex;
  Vec3 from, to;
  double spare;
};

class Candidates {
 public:
  /// Pairs that keep this distance on their carried way need no CCD [m].
  static constexpr double k_clear = 1e-4;

  explicit Candidates(const ClothModel& model);

  /// Pairs that are left alone until the next call; it has to stay.
  void leave_open(const WayOut& way_out) { way_out_ = &way_out; }

  /// Finds the surfaces near the cloth for carry(), and how fast they come.
  void find_near(const ClothMotion& cloth, double h, const PieceMotion& piece);
  /// Fills piece.carry: near the body its motion, else the cloth's own. After find_near(); forgets zones.
  void carry(const ClothMotion& cloth, double h, PieceMotion& piece);
  /// Collects pairs(); returns the share of the motion, in (0, 1], after which the first of them is about to touch.
  /// After carry().
  double collect(const ClothMotion& cloth, double h, PieceMotion& piece);
  /// After a collect() that gave less than 1: carries the cloth of all pairs that would have touched since then so that
  /// they keep apart, if that can be, brings pairs() up to it, no longer in order, and returns the share anew.
  double part_blocked(const ClothMotion& cloth, PieceMotion& piece);
  /// After the last part_blocked() of a carry(), however that ended: frees what it knows.
  void end_parting() { limits_.clear(); }
  /// After collect(), part_blocked() or join_blocked() that gave less than 1: carries the cloth of the pairs that would
  /// touch as one, brings pairs() up to it, no longer in order, and returns the share anew.
  double join_blocked(const ClothMotion& cloth, PieceMotion& piece);
  /// Whether cloth is about to touch cloth, by the last collect() or join_blocked().
  bool cloth_blocks_cloth() const;
  /// Gives vertices other balls, which hold the straight way that they ask for and not all of their last ones, and adds
  /// what these need to pairs(), behind those that are there, for a piece that is carried already. The vertex must be
  /// at `from`. What release_blocked() has dropped stays out.
  void give_room(const ClothMotion& cloth, std::span<const RoomRequest> requests, PieceMotion& piece);
  /// pairs() lacks those inside patches of cloth that are too flat to meet themselves. For a solve that is about to put
  /// the cloth at x (per cloth vertex [m], straight from where it was last kept): returns true where all are still flat
  /// there; else it adds what is needed now behind pairs(), and returns false.
  bool keep_flat(const ClothMotion& cloth, std::span<const Vec3> x, const PieceMotion& piece);
  /// Adds pairs of cloth with cloth behind pairs(), near or not: what was left open is so no longer.
  void hold(const ContactPairs& closed);
  /// Takes out the pairs that collect() or join_blocked() last saw touch. Where cloth is joined between several of the
  /// collider's parts, the smaller ones are let go there; else what the pairs have of the collider is (noted in
  /// cloth.absent; returns how many vertices). Pairs of cloth with cloth are only dropped.
  /// deep: as SubstepInput::deep_t1. whole: all of the collider is let go for the garments that are blocked.
  int release_blocked(ClothMotion& cloth, const PieceMotion& piece, std::span<const char> deep, bool whole = false);

  const PairList& pairs() const { return pairs_; }

 private:
  struct Touching;

  /// Whether no garment meets it.
  bool is_gone(const ClothMotion& cloth, std::size_t body_vertex) const;
  bool counts(const ClothMotion& cloth, PairKind kind, const Stencil& stencil) const;
  int part_of(const Stencil& stencil) const;
  void place(std::size_t vertex, const ClothMotion& cloth, PieceMotion& piece);
  void set_box(std::size_t vertex, const PieceMotion& piece);
  double renew(const ClothMotion& cloth, const PieceMotion& piece);
  double renew_carried(const ClothMotion& cloth, PieceMotion& piece);
  void add_touching(PairKind kind, const PieceMotion& piece, Touching& touching) const;
  void begin_flat(const PieceMotion& piece);
  void mark_lost();
  void add_missing(const ClothMotion& cloth, const PieceMotion& piece);
  bool is_blocked(PairKind kind, PairKey key) const;
  void drop_blocked();
  void join_zones(const PieceMotion& piece);
  std::vector<int> pinched_through() const;
  PairSieve sieve(const ClothMotion& cloth, const PieceMotion& piece, Touching* touching) const;

  const ClothModel& model_;
  const WayOut* way_out_ = nullptr;
  PairFinder finder_;
  FlatPatches patches_;
  double radius_ = 1e-3, self_radius_ = 0;
  bool any_self_ = false;
  std::vector<double> most_spare_;  ///< per garment, of the slack that is not for the way [m]

  // Of the piece.
  double range_ = 0;           ///< of near_body_ [m]
  double fastest_ = 0;         ///< largest body motion near the cloth, relative to the cloth's mean [m]
  double h_ = 0;               ///< s
  Vec3 frame_ = Vec3::Zero();  ///< mean carry: boxes move with it [m]
  std::vector<char> changed_;  ///< per vertex: whose pairs have to be looked for anew
  std::vector<char> moved_;    ///< per vertex: whose carried way has changed
  BoxFrame box_frame_;
  std::vector<VertexBox> boxes_;
  PairList near_body_, pairs_;
  PairRuns runs_vertex_face_, runs_edge_edge_;  ///< of pairs_
  std::vector<Vec3> inertia_;                   ///< h v, from carry() to collect() [m]
  ContactPairs blocked_;
  ApproachLimits limits_;
  MotionZones zones_;
  std::vector<int> lost_;  ///< patches that are flat no longer
};

}  // namespace ft::inline solvers
