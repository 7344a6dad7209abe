// Where the body is torn in a frame: its skin spans a gap, or a part leaps to another place while the body does not.
// A broken rig does it, and an import gone wrong. No motion of cloth is right there, and to sweep it through the cloth
// costs more than the rest of the shot; so cloth does not meet it in that frame (absence.h). A function of the body's
// motion alone. Caution: what is quick and real is like the motion of the frame before or after, and never counts.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline solvers {

class TornBody {
 public:
  TornBody() = default;
  /// bind: of the body [m].
  TornBody(std::span<const Vec3> bind, std::span<const Triangle> triangles, std::span<const int> part_of_vertex);

  /// What most of it does, a median, between the frame's ends [m].
  static Vec3 common_move(std::span<const Vec3> start, std::span<const Vec3> end);

  /// Positions of the same vertices at another frame's end: -1 is the frame before the start, 1 that after the end [m].
  using Neighbour = std::function<std::vector<Vec3>(int)>;
  /// Between the frame's ends [m], per vertex: 1 where it is torn, else 0. Empty: nowhere.
  std::vector<char> find(std::span<const Vec3> start, std::span<const Vec3> end, const Neighbour& neighbour) const;

 private:
  std::vector<Edge> edges_;
  std::vector<double> longest_;   ///< per edge: longer is no skin [m]
  std::vector<int> part_;         ///< per vertex
  std::vector<double> farthest_;  ///< per part: farther against the body is no motion, unless its neighbours say so [m]
};

}  // namespace ft::inline solvers
