// The visible surface of cords: a tube of quads about each strand, closed at its ends. Its vertices follow from where
// the points are now, and from nothing before: a frame about a strand's first cord, turned with the whole, then carried
// along the strand without twist (rotation-minimizing frames; Bergou et al. 2008, "Discrete elastic rods", section 4).
#pragma once

#include <span>
#include <vector>

#include "baker/core/mesh.h"
#include "solvers/cords/cord_graph.h"

namespace ft::inline solvers {

class CordTubes {
 public:
  static constexpr int k_sides = 6;

  /// radius: of every tube [m], > 0; vertices lie on it. Strands have at least two points.
  CordTubes(const CordGraph& graph, double radius, std::string name = "cords");

  /// At rest: tubes in the order of the strands, each a ring of k_sides vertices after the other.
  const Mesh& mesh() const { return mesh_; }

  /// The first vertex of mesh() around a point, where strands meet of the first of them; -1: no strand has it.
  int vertex_of(int point) const;

  /// Vertices of mesh() for these points (as many as the graph has) into `out`. Moved rigidly as a whole, the tubes
  /// move along; those of a straight rope up to a turn about itself. Points in one place are no harm.
  void place(std::span<const Vec3> points, std::span<Vec3> out) const;

 private:
  /// Points that are joined, whose common rotation turns the frames.
  struct Piece {
    std::vector<int> points;
    bool straight = false;  ///< at rest, on a line: it has no rotation to tell
  };
  struct Seed {
    Vec3 tangent, normal;  ///< a direction and one across it, that turn with the piece
    std::size_t piece = 0;
  };
  std::vector<Piece> find_pieces(const CordGraph& graph) const;
  Quat rotation(const Piece& piece, std::span<const Vec3> points) const;

  double radius_;
  std::vector<Vec3> rest_;
  std::vector<std::vector<int>> strands_;
  std::vector<int> first_vertex_;  ///< of each strand
  std::vector<Piece> pieces_;
  std::vector<Seed> seeds_;  ///< of each strand
  Mesh mesh_;
};

}  // namespace ft::inline solvers
