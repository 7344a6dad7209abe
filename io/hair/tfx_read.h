// TressFX strands.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/types.h"

namespace ft::inline io {

/// Strands of a .tfx file, version 4, in its own unit.
Result<std::vector<std::vector<Vec3>>> read_tfx(const std::filesystem::path& file, std::vector<std::string>& notes);

}  // namespace ft::inline io
