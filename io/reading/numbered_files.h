// Frames that are a file each.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "baker/core/result.h"

namespace ft::inline io {

struct NumberedFiles {
  std::int64_t first = 0;                    ///< number of the first; the others follow without a gap
  std::vector<std::filesystem::path> files;  ///< at least one, in order
};

/// The files beside `named` that are called prefix, a number of at most 12 digits, suffix. Input errors, which name
/// `named`: there is none, one is missing in between, two have the same number.
Result<NumberedFiles> numbered_files(const std::filesystem::path& named, std::string_view prefix,
                                     std::string_view suffix);

}  // namespace ft::inline io
