// [cloth.NAME] of the shot file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "baker/core/types.h"
#include "io/shot/secondary.h"
#include "solvers/cloth/model/cloth_settings.h"

namespace ft::inline baker {

/// One way to hold a garment to its primary, or to a garment.
inline constexpr std::string_view k_pin_world = "world";  ///< PinSpec::to: a place that does not move
struct PinSpec : ClothPinSettings {
  enum class Select { k_group, k_within, k_vertices, k_file };
  Select select = Select::k_group;
  std::string group;                  ///< vertex group of the garment's mesh
  double within = 0;                  ///< garment vertices nearer than this to the body in the bind pose [m]
  std::vector<int> vertices;          ///< garment vertices, from 0, file order
  std::filesystem::path file;         ///< values file with a weight per vertex, see vertex_values.h
  std::string column;                 ///< of `file`; empty: the only one
  std::optional<double> from, until;  ///< frames of the shot: it holds after the one, and up to and including the other
  double fade = 0;                    ///< frames that its force takes to come after `from` and to go after `until`
  std::string to;  ///< name of the cloth that it holds to, on the same primary, or "world"; empty: the primary
};

/// What varies over a garment, and where its values come from: see cloth_maps.h for what can vary.
struct MapSpec {
  std::string of;                   ///< "thickness", "stretch", ...
  std::string from;                 ///< vertex group or colour channel, whose weights run from 0 to 1; or
  std::filesystem::path file;       ///< values file
  std::string column;               ///< of `file`; empty: the only one
  std::optional<double> low, high;  ///< value at 0 and at 1; without them the file's numbers are the values
};

inline constexpr std::string_view k_faces_triangles = "triangles";  ///< ClothSpec::faces

/// [cloth.NAME]: what follows.
struct ClothSpec final : SecondarySpec, ClothSettings {
  std::filesystem::path mesh;     ///< OBJ (own reader, file's vertex order)
  std::string fabric = "cotton";  ///< name of a measured fabric
  std::vector<PinSpec> pins;
  std::vector<MapSpec> maps;
  std::vector<std::pair<std::string, double>> fabric_overrides;  ///< "mass_per_area" = 0.2 ...: keys of solvers' Fabric
  double weld = 0;        ///< garment vertices nearer than this are joined for the simulation [m]; 0: none, see weld.h
  double unit_scale = 1;  ///< m per mesh unit
  std::string up = "y";
  Vec3 offset = Vec3::Zero();  ///< m, added after scale and axis
  std::string faces = "file";  ///< of the caches: those of the file, or the "triangles" that are simulated
  std::string rest;  ///< "mesh": rest lengths of the placed mesh; "pattern": of the flat pattern in vt; "": pattern if
                     ///< it is sewn
  double pattern_scale = 1;             ///< m per unit of vt
  std::vector<std::string> ignores;     ///< patterns (* and ?) of parts of its primary that it does not meet
  std::vector<std::string> meets{"*"};  ///< patterns of primaries that it meets beside its own
};

}  // namespace ft::inline baker
