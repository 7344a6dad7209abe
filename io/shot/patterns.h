// Lists of names in the shot file that may hold * and ?: parts, joints, primaries.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "baker/core/result.h"

namespace ft::inline io {

/// Indices of the names that are what one of the patterns says, ascending. Error (k_usage): the first pattern that
/// names none, with what may have been meant. key: "ignore", of the shot file. what: "part of \"ann\"", for the
/// message.
Result<std::vector<int>> indices_like(std::span<const std::string> patterns, std::span<const std::string> names,
                                      std::string_view key, std::string_view what);

}  // namespace ft::inline io
