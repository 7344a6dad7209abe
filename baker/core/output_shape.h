// The shapes that an output may have, and what each needs once (at rest) and in every frame.
//
//   shape      once                                      every frame
//   mesh       Mesh: faces, uvs, rest positions          positions, velocities, scalars by name; faces that change
//   curves     CurveSet: vertices of each curve, widths  positions, velocities
//   points     nothing                                   ids, positions, velocities, widths; any number of points
//   instances  InstanceSet: ids, prototypes              positions, orientations, scales, both kinds of velocity
//   grid       no format takes it yet
//
// Solvers say which of them a system has (solvers/base/solver.h); which format takes what is a property of the format
// (io/cache/cache.h). A frame itself is output_frame.h.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/types.h"

namespace ft {

enum class OutputShape : std::uint8_t { k_mesh, k_curves, k_points, k_instances, k_grid };

/// "a mesh", "curves" ...: for messages.
std::string_view shape_name(OutputShape shape);
/// "mesh", "curves", "points", "instances", "grid": for files.
std::string_view shape_key(OutputShape shape);
/// Of such a key; none: there is no such shape.
std::optional<OutputShape> find_shape(std::string_view key);

/// What the frames of a cache hold. A format is asked with it whether it takes them and what they cost.
struct FrameContent {
  OutputShape shape = OutputShape::k_mesh;
  bool changes = false;             ///< faces of a mesh or number of points change from frame to frame
  bool velocities = true;           ///< meshes that do not change: the first frame says it, and this is an estimate
  bool widths = false;              ///< points: a width each, every frame
  bool angular_velocities = false;  ///< instances
  bool scales = false;              ///< instances
  /// Meshes: names of scalars that each vertex has in every frame, "foam"; none twice.
  std::vector<std::string> scalars{};
  bool operator==(const FrameContent&) const = default;
};

/// How much there is of it in one frame; where that changes, as a rule.
struct FrameCounts {
  std::uint64_t elements = 0;            ///< vertices, points or instances
  std::uint64_t faces = 0, corners = 0;  ///< only where faces change
};

/// One value for all together, for each curve or instance, or for each vertex of the curves.
enum class AttributeScope : std::uint8_t { k_all, k_each, k_vertex };

/// Named values that never change: hair calls them groom attributes.
struct CacheAttribute {
  std::string name;  ///< "groom_group_id"
  AttributeScope scope = AttributeScope::k_all;
  std::variant<std::vector<std::int16_t>, std::vector<std::int32_t>, std::vector<float>, std::vector<Eigen::Vector2f>,
               std::vector<std::string>>
      values;
  bool operator==(const CacheAttribute&) const = default;
};

/// Polylines. Their vertices stand in turn, curve by curve.
struct CurveSet {
  std::vector<int> vertices_per_curve;  ///< at least 2 each
  std::vector<Vec3> rest;               ///< of all vertices [m]
  std::vector<float> widths;            ///< diameters [m]: one for all, for each curve or for each vertex; may be empty
  std::vector<std::uint64_t> ids;       ///< for each curve, below 2^31; may be empty
  int curve_count() const { return static_cast<int>(vertices_per_curve.size()); }
};

/// Copies of prototypes, as leaves are. Their number never changes; what is not there has scale 0.
struct InstanceSet {
  std::vector<std::uint64_t> ids;  ///< for each instance, none twice
  std::vector<int> prototypes;     ///< for each instance, an index into prototype_names
  std::vector<std::string> prototype_names;
};

/// What a system is in the caches that is no mesh of constant topology, as far as it is the same in all frames.
struct SystemShape {
  std::string name;
  FrameContent content;
  CurveSet curves;
  InstanceSet instances;
  std::vector<Mesh> prototypes;  ///< of instances: a mesh for each of prototype_names, about its own origin [m]
  std::vector<CacheAttribute> attributes{};  ///< of curves and instances

  /// Vertices, points or instances in a frame; 0 where their number changes.
  int element_count() const;
};

/// What of it does not fit together: numbers of prototypes and meshes, an index without a prototype. Empty: it fits.
std::string fault_of_prototypes(const SystemShape& shape);

/// Meshes as one, in turn, each a group of its name; uvs where all have them.
Mesh joined_meshes(std::string name, std::span<const Mesh> meshes);

}  // namespace ft
