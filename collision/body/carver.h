// Carves the parts of one pose: each part leaves the larger ones, which are final by then. One part: find its vertices
// near or inside larger parts (carver_sides.cpp), push them out, smooth the displacement so that no triangle tears,
// push out again, then lift edges that sag into a curved larger part (carver.cpp). Never changes between calls; all
// that a pose needs is in Scratch.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "collision/body/carve_plan.h"
#include "collision/body/feasible_collider.h"
#include "collision/body/nearby_triangles.h"
#include "collision/body/part_distance.h"

namespace ft::inline collision {

inline constexpr std::size_t k_carve_block = 16 * k_cluster;  ///< vertices per parallel block

/// Where a vertex is with respect to one opponent.
enum class Side : char { k_away, k_near, k_unknown, k_inside };

struct Carver {
  FeasibleSettings settings;
  std::unique_ptr<PartSurface> surface;
  CarvePlan plan;
  double near =
      0;  ///< distances up to this are always found [m]; above half an edge, so that no edge passes a surface unseen

  /// Positions, boxes and trees of one evaluation.
  struct Scratch {
    std::span<Vec3> x;
    std::vector<TreeBox> boxes;
    std::vector<TriangleTree> trees;
  };
  struct Contact {
    Vec3 normal = Vec3::Zero();
    double distance = std::numeric_limits<double>::infinity();  ///< to the nearest opponent [m]
    bool squeezed = false;  ///< in a slot between two opponents that is too narrow for both distances
  };
  /// One part's work in one evaluation.
  struct Carving {
    const Yielding& part;
    std::vector<Opponent> opponents;  ///< those near enough now
    std::vector<Contact> contacts;    ///< per local vertex
    std::vector<char> inside;         ///< per local vertex: deep inside an opponent
    std::vector<char> is_active;      ///< per local vertex
    std::vector<int> active;          ///< local vertices that may have to move, ascending
    std::vector<char> moved;
  };

  TreeBox box_of(int part, std::span<const Vec3> x) const;
  std::vector<Opponent> opponents_now(const Yielding& part, const TreeBox& own, Scratch& scratch) const;
  void find_active(Carving& carving, const Scratch& scratch) const;
  void look_around(Carving& carving, const Opponent& opponent, const Scratch& scratch, std::size_t begin,
                   std::size_t end, NearbyTriangles& nearby, std::vector<Side>& side) const;
  void resolve_unknown(const Carving& carving, const Opponent& opponent, const Scratch& scratch,
                       std::vector<Side>& side) const;
  template <class Keep, class Reach>
  bool push(const Carving& carving, const Scratch& scratch, Vec3& point, std::span<int> hints, Keep&& keep,
            Reach&& reach, Contact* contact) const;
  bool push_out(const Carving& carving, int local, const Scratch& scratch, Vec3& point, Contact& contact,
                std::span<int> hints) const;
  bool lift_middle(const Carving& carving, const Edge& edge, const Scratch& scratch, Vec3& middle,
                   std::span<int> hints) const;
  void push_out_all(Carving& carving, bool again, Scratch& scratch) const;
  void span_slots(Carving& carving, Scratch& scratch) const;
  void smooth(const Carving& carving, std::span<const Vec3> drawn, Scratch& scratch) const;
  void lift_edges(const Carving& carving, Scratch& scratch) const;
  void give_way(int part, Scratch& scratch) const;
  int deepest_opponent(const Yielding& part, const Vec3& point, const Scratch& scratch) const;
};

}  // namespace ft::inline collision
