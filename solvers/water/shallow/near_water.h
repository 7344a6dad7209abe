// Water near bodies: under them one head per cell decides, and its storage V(head; pose) says how much water a cell
// holds at that head, from the spans of its columns. Explicit outside, implicit here, with one flux per face:
//
//   V(head + dhead, pose) = h - dt div(depth u*) + g dt^2 div(depth grad dhead),   M (v - v*) = dt F(head, pose)
//
// Newton's method on both, for all bodies that float together. A top counts only where water from a free neighbour
// stands above it; else a body reaches up without end. No suction: pressure is never below that of the air.
#pragma once

#include <span>
#include <vector>

#include "baker/core/rigid.h"
#include "baker/core/wrench.h"
#include "solvers/water/body_columns.h"
#include "solvers/water/shallow/flow.h"
#include "solvers/water/shallow/near_system.h"

namespace ft::inline solvers {

struct NearLaws {
  double gravity = k_gravity, density = 1000;
  double cap = 10;  ///< head that contact bears, above a bottom [m]
};

/// A body as the water meets it, in one pose.
struct NearBody {
  BodySurface surface;
  Vec3 about = Vec3::Zero();  ///< of its torques [m]
  // Of one that floats:
  bool floats = false;
  Mat6 mass = Mat6::Identity();    ///< with added mass; world axes, about its centre of mass
  Vec6 free = Vec6::Zero();        ///< v*: its velocity and spin at the step's end without the water's pressure
  Vec6 posed = Vec6::Zero();       ///< velocity and spin that brought it into this pose
  Vec6 rest_force = Vec6::Zero();  ///< beside that of the columns: the geometric residual
  Vec6 velocity = Vec6::Zero();    ///< result
};

/// Scratch of the steps of one flow; nothing of it outlives a step.
class NearWater {
 public:
  struct Cell {
    int i = 0, k = 0;
    std::size_t c = 0;       ///< of the flow
    int begin = 0, end = 0;  ///< reaches
    int spans_begin = 0, spans_end = 0;
    double capacity = 0;         ///< thickness that it can hold; infinite where there is a free column [m]
    double gives = 0;            ///< the lowest head at which a top of it counts [m]
    double covered = 0;          ///< share of its columns under a bottom that is in the water [1]
    double head0 = 0, head = 0;  ///< m, at the step's start and now
    double aim = 0;              ///< thickness to hold [m]
    double volume = 0, slope = 0;
  };

  /// Which cells are near, from the bodies' surfaces at the step's end. `world_x`, `world_z`: of cell (0, 0)'s corner.
  void find(const Flow& flow, std::span<const NearBody> bodies, double world_x, double world_z, const NearLaws& laws);
  /// Solves for heads and the velocities of those that float; corrects the flow's u1, w1, qx1, qz1. `first`: whether
  /// the heads start from the flow's; else from those of the same step's solve before.
  void solve(Flow& flow, std::span<NearBody> bodies, const NearLaws& laws, double dt, bool first);
  /// After step_depths(): puts the heads into the flow, whose lift was cleared.
  void keep_heads(Flow& flow) const;

  std::span<const Cell> cells() const { return cells_; }
  void clear() { cells_.clear(), reaches_.clear(), ni_ = nk_ = 0; }
  int index(int i, int k) const {
    const bool inside = i >= i0_ && k >= k0_ && i < i0_ + ni_ && k < k0_ + nk_;
    return inside ? index_[at(i - i0_) + at(ni_) * at(k - k0_)] : -1;
  }
  /// Thickness that a cell holds at a head [m].
  double holds(const Flow& flow, const Cell& cell, double head) const;
  /// Force and torque of the water's pressure on a body, with `level` in place of all heads if given.
  Vec6 force(std::size_t body, const NearBody& b, const NearLaws& laws, double cell_size, const double* level) const;
  /// Mean level of the free cells around a body, weighted alike; none where there is none.
  bool level_around(std::size_t body, const Flow& flow, double& level) const;

  /// Of the water in a cell, by density, gravity and area: the integral of its height [m2].
  double potential(const Flow& flow, const Cell& cell) const;

  int newton_count = 0, linear_count = 0, failed_count = 0;  ///< since made
  double residual = 0;                                       ///< the largest, of the last solve [m]

 private:
  /// A span as the water meets it: pressure from `bottom` on, held against from `top` on.
  struct Reach {
    double bottom, top;            ///< m
    Vec3 bottom_way, top_way;      ///< n / n.y
    Vec3 bottom_place, top_place;  ///< in the world [m]
    int bottom_body, top_body;
  };
  void gate(const Flow& flow, const NearLaws& laws);
  void couple(Flow& flow, const NearLaws& laws, double dt);
  /// Volumes, slopes and forces at the cells' heads, bodies moved on by so much from their poses; the merit of it.
  double evaluate(std::span<const NearBody> bodies, const NearLaws& laws, double dt, double cell_size);
  void assemble(std::span<const NearBody> bodies, const NearLaws& laws, double dt, double cell_size);
  void correct(Flow& flow, const NearLaws& laws, double dt);
  static Vec6 lever(const Vec3& way, const Vec3& place, const Vec3& about);

  ColumnGrid grid_;
  BodyColumns columns_;
  int i0_ = 0, k0_ = 0, ni_ = 0, nk_ = 0;
  std::vector<int> index_;
  std::vector<char> near_;
  std::vector<Cell> cells_;
  std::vector<Reach> reaches_;
  std::vector<double> open_, guess_;
  std::vector<int> guess_time_;
  int time_ = 0;  ///< counts steps, to tell fresh guesses
  std::vector<char> span_open_;
  NearSystem system_;
  std::vector<double> bed_, delta_, before_, rest_;
  std::vector<std::array<double, 4>> depth_;  ///< at a cell's faces, as NearSystem::neighbour
  std::vector<Vec6> force_, velocity_before_;
};

}  // namespace ft::inline solvers
