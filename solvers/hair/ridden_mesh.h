// A hair mesh, as of cards or tubes, that goes with the guides that run in the middle of its pieces.
#pragma once

#include <span>
#include <vector>

#include "solvers/hair/hair_roots.h"
#include "solvers/hair/hair_setup.h"
#include "solvers/hair/strands_between.h"

namespace ft::inline solvers {

class RiddenMesh {
 public:
  /// groom: the guides as they were combed, of so many vertices each, and their roots, in the bind pose.
  RiddenMesh(const Mesh& mesh, std::span<const MeshRider> riders, int vertices, const GuidesNow& groom,
             std::span<const RootFrame> roots);

  /// As many positions as the mesh has vertices [m].
  void place(const GuidesNow& guides, std::span<const RootFrame> roots, std::span<Vec3> positions) const;

 private:
  /// Between two vertices of a guide; or, along < 0, with a root.
  struct Place {
    std::size_t strand = 0, vertex = 0;
    double along = -1;  ///< from the vertex to the next
    Vec3 off[2];        ///< in the frames of both, or of the root [m]
  };
  std::size_t n_ = 0;
  std::vector<Place> places_;
};

}  // namespace ft::inline solvers
