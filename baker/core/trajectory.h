// The primary, as everybody else sees it: one closed (or nearly closed) triangle surface, or sheets, with constant
// topology and a position for every vertex at every time of the shot. Positions are metres, Y-up, world space.
// Thread-safe: sampling changes nothing.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft {

/// A piece of the surface that moves as one: all that follows one bone, or one closed shell. Overlapping parts are what
/// makes a collider infeasible, see collision/body/feasible_collider.h.
struct SurfacePart {
  std::string name;
  int parent = -1;  ///< part it is jointed to, -1 for the root
  double size = 0;  ///< volume or area measure [m3]; the larger part wins where two overlap
  /// The joint with the parent is one about which it turns as a limb does, so that the two skins fold there; false: it
  /// rides on the parent, like an eye or a nail.
  bool folds = true;
  /// It stands still in the whole shot, as a ground or a chair does: what overlaps it gives way, whatever its size.
  bool fixed = false;
  /// Thin and open, as cloth of an earlier bake is: it has two sides and no inside. It neither gives way to other parts
  /// nor do they to it, and it makes none of them absent.
  bool sheet = false;
};

struct Surface {
  std::vector<Triangle> triangles;
  std::vector<int> part_of_vertex;  ///< one per vertex, into parts
  std::vector<SurfacePart> parts;   ///< at least one
  int vertex_count() const { return static_cast<int>(part_of_vertex.size()); }
};

/// What of the surface has an inside: its triangles that belong to no sheet.
std::vector<Triangle> solid_triangles(std::span<const Triangle> triangles, std::span<const int> part_of_vertex,
                                      std::span<const SurfacePart> parts);
inline bool has_sheets(std::span<const SurfacePart> parts) {
  return std::any_of(parts.begin(), parts.end(), [](const SurfacePart& part) { return part.sheet; });
}

/// Times are seconds from the first frame of the shot. t < 0 is the pre-roll: at t <= -preroll the bind pose, placed
/// where the first frame has the character (position and heading), from there blended into the pose at t = 0. A
/// character that enters the shot at speed starts further back and picks the speed up towards t = 0.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  virtual const Surface& surface() const = 0;
  /// Positions of all vertices in the pose that garments are modelled on; file placement.
  virtual void bind_pose(std::span<Vec3> positions) const = 0;
  /// bind_pose(), but of several bodies in one each placed where it starts, so that they do not stand in each other.
  virtual void bind_pose_apart(std::span<Vec3> positions) const { bind_pose(positions); }
  virtual void sample(double time, std::span<Vec3> positions) const = 0;
  /// Takes file placement of the bind pose to where the pre-roll starts: garments are moved by it once.
  virtual Eigen::Isometry3d bind_to_start() const = 0;
  /// Length of the pre-roll blend [s], >= 0.
  virtual double preroll() const = 0;
};

/// bind_pose() [m].
inline std::vector<Vec3> bind_pose_of(const Trajectory& trajectory) {
  std::vector<Vec3> out(static_cast<std::size_t>(trajectory.surface().vertex_count()));
  trajectory.bind_pose(out);
  return out;
}

/// bind_pose_apart() [m].
inline std::vector<Vec3> bind_pose_apart_of(const Trajectory& trajectory) {
  std::vector<Vec3> out(static_cast<std::size_t>(trajectory.surface().vertex_count()));
  trajectory.bind_pose_apart(out);
  return out;
}

}  // namespace ft
