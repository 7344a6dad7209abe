// Which of a file's grids are the velocities.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/result.h"

namespace ft::inline io {

struct VdbGridName {
  std::string name;
  std::string holds;  ///< "vec3s", "vec3d", "float", "double", or something that is no velocity
};

/// One index, or three: of the x, y and z components. An input error that lists what there is when there is no such
/// grid, or none is named and several could be meant. See read_vdb_velocity().
Result<std::vector<std::size_t>> choose_velocity(std::span<const VdbGridName> grids, const std::string& name);

}  // namespace ft::inline io
