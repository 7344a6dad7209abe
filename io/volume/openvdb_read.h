// OpenVDB, inside the program that it is linked into: followthrough_read_vdb. Others call vdb_read.h.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "baker/core/result.h"
#include "io/volume/vdb_read.h"

namespace ft::inline io {

/// As read_vdb_velocity(), in this process, which damaged files may bring down. Its errors do not name the file. Throws
/// bad_alloc and nothing else.
Result<VdbVelocity> read_with_openvdb(const std::filesystem::path& file, const std::string& grid,
                                      std::int64_t most_voxels);

}  // namespace ft::inline io
