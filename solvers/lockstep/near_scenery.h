// The triangles of the scenery that cords can meet in a step, and the search among them: a character has many, and few
// are where the cords are. What is chosen decides how long a search takes and nothing else.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "collision/broad_phase/pair_finder.h"
#include "solvers/lockstep/scenery.h"

namespace ft::inline solvers {

class NearScenery {
 public:
  /// Both have to stay. point_count, cords: as PairFinder takes them.
  NearScenery(const Scenery& scenery, int point_count, std::span<const Triangle> cords);

  /// What was chosen for another step is forgotten.
  void forget() { covered_ = Box(); }
  /// From now on all triangles are chosen that come into this box on their way [m].
  void cover(const Box& box);

  std::span<const int> vertices() const { return vertices_; }  ///< chosen ones of the scenery, ascending
  /// Chosen ones, numbered as for find().
  std::span<const Triangle> triangles() const { return triangles_; }
  double largest_way() const { return largest_way_; }  ///< of a chosen vertex in the step [m]
  /// Pairs of cords with what is chosen: numbered points first, then the chosen vertices.
  void find(std::span<const VertexBox> boxes, std::span<const Vec3> places, PairList& out);

 private:
  const Scenery& scenery_;
  int point_count_;
  std::span<const Triangle> cords_;
  Box covered_;
  std::vector<int> vertices_;
  std::vector<Triangle> triangles_;
  double largest_way_ = 0;
  std::optional<PairFinder> finder_;
  bool arranged_ = false;
};

}  // namespace ft::inline solvers
