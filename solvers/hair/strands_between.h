// Strands that are not solved: each goes with up to three guides, from between them at its root to beside the nearest
// of them farther out, in the guides' own frames. Then its segments get their lengths back, and what that has put into
// a body is pushed out, and what goes through a sheet goes nearer to its guide, which does not. What they are is a
// function of the guides and the bodies at a time.
#pragma once

#include <array>
#include <mutex>
#include <span>
#include <vector>

#include "solvers/hair/hair_bodies.h"
#include "solvers/hair/hair_roots.h"
#include "solvers/hair/hair_setup.h"

namespace ft::inline solvers {

/// Guides as they are, all their vertices in turn without ghosts.
struct GuidesNow {
  std::span<const Vec3> x, v;      ///< m, m/s
  std::span<const Vec3> director;  ///< of the edge that starts at a vertex; of the last one the edge before
};

/// A frame at each vertex: along the strand, and the director.
std::vector<Mat3> frames_of(const GuidesNow& guides, std::size_t vertices);

class StrandsBetween {
 public:
  /// scalp: on which their roots are. groom: the guides as they were combed, in the bind pose. bodies have to stay.
  StrandsBetween(std::span<const BetweenStrand> strands, int vertices, std::shared_ptr<const Trajectory> scalp,
                 const GuidesNow& groom, std::span<const HairBody> bodies);

  int count() const { return static_cast<int>(strands_.size()); }
  /// At a time [s]: vertices of all strands in turn. Velocities are those of the guides, mixed.
  void place(const GuidesNow& guides, double time, std::vector<Vec3f>& x, std::vector<Vec3f>& v) const;

 private:
  struct Strand {
    std::array<int, 3> guides;  ///< -1: none
    std::array<double, 3> share;
  };
  /// The place of a guide's vertex that is nearest to a body.
  struct Plane {
    Vec3 place, normal;
    double gap = 1;  ///< m; 1: nothing is near
  };
  std::vector<Plane> planes_near(const GuidesNow& guides) const;
  bool push_out(const Plane& of_guide, const Vec3& guide, double keeps, Vec3& p) const;
  void clear_sheets(const GuidesNow& guides, std::span<const Plane> planes, std::size_t strand,
                    std::span<Vec3> p) const;

  std::size_t n_ = 0;
  std::shared_ptr<const Trajectory> scalp_;
  HairRoots roots_;
  std::vector<Strand> strands_;
  std::vector<std::array<Vec3f, 3>> offsets_;  ///< of each vertex, in the frames of its guides' vertices [m]
  std::vector<float> lengths_;                 ///< of the segment before each vertex [m]
  std::vector<float> keeps_;                   ///< gap of each vertex to bodies that it is pushed out to [m]
  mutable std::mutex busy_;
  mutable HairBodies bodies_;
};

}  // namespace ft::inline solvers
