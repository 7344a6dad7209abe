// Where a fault of a plan is.
#pragma once

#include "io/shot/shot.h"

namespace ft::inline baker {

/// The error with "shot.toml: cloth "skirt"" in front of where it is. owner: "cloth "skirt"".
Error located(Error error, const Shot& shot, const std::string& owner);

}  // namespace ft::inline baker
