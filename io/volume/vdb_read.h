// Velocities from OpenVDB files, as fluid solvers write them, for wind. A file is read by the program
// followthrough_read_vdb, which lies beside this one, as a guarded child: the library crashes on some damaged files,
// and loading it takes longer than this program's whole start. No type of the library comes out. Files have no
// checksums: a damage that leaves sensible numbers is not seen.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "baker/core/bytes.h"
#include "baker/core/result.h"
#include "baker/core/types.h"
#include "io/reading/guarded_child.h"
#include "io/reading/numbered_files.h"

namespace ft::inline io {

/// One frame: the box of the voxels that are active. All zero counts where none is.
struct VdbVelocity {
  std::string grid;                ///< its name in the file; of three: "vel.x vel.y vel.z"
  std::array<int, 3> lowest{};     ///< index of the first voxel, as the file counts them
  std::array<int, 3> count{};      ///< along x, y, z; velocities has that many, x fastest
  Eigen::Affine3d to_world;        ///< from indices to the file's units and axes; the centre of voxel i is at i
  std::vector<Vec3f> velocities;   ///< file units per second, its axes; finite
  std::vector<std::string> notes;  ///< what was changed or is odd
};

struct VdbOptions {
  std::int64_t most_voxels = std::int64_t{64} << 20;  ///< of the box of a frame, which is 12 bytes each in memory
  ChildLimits limits;
  std::filesystem::path reader;  ///< the program followthrough_read_vdb; empty: beside this program
};

/// A grid of vec3s or vec3d, also when stored as half floats: the named one, without a name "v", "vel", "velocity" or
/// "Velocity", else the only one. Or three of float or double, such as vel.x vel.y vel.z, vel_x or velx; they are named
/// "vel". What a staggered (MAC) grid has on faces is averaged to the centres, with a note; three grids may lie half a
/// voxel apart for it.
/// Input errors, all of which name the file: it cannot be read, is cut or no VDB file; has no such grid, and what it
/// has; is not linear in space (frustum); has too many voxels; numbers that are not finite; what read_in_child() says.
Result<VdbVelocity> read_vdb_velocity(const std::filesystem::path& file, const std::string& grid = {},
                                      const VdbOptions& options = {});

/// The frames' files: "air.####.vdb" or "air.%04d.vdb", with any number of digits; a file that has no such mark in its
/// name is one alone, numbered 0. Input errors: as of numbered_files().
Result<NumberedFiles> find_vdb_sequence(const std::filesystem::path& pattern);

/// All files of a sequence, which are of at most `most_voxels` together.
Result<std::vector<VdbVelocity>> read_vdb_sequence(const NumberedFiles& sequence, const std::string& grid = {},
                                                   const VdbOptions& options = {},
                                                   std::int64_t most_voxels = std::int64_t{256} << 20);

/// To metres, m/s and y up. unit_scale: m per file unit, > 0; up: "y" or "z", anything else is as "y".
void to_metres(VdbVelocity& velocity, double unit_scale, std::string_view up);

/// How the child hands over what it read: all but the velocities, behind which these follow.
Bytes vdb_head(const VdbVelocity& velocity);
Result<VdbVelocity> load_vdb(std::span<const std::byte> bytes);

}  // namespace ft::inline io
