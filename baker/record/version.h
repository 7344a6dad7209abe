// What this program calls itself. A bake is stale when either changes: the same binary gives the same bytes, another
// may not.
#pragma once

#include <string>

namespace ft::inline baker {

/// "0.1.0".
std::string program_version();
/// Content hash of the running executable, 32 hex digits; "unknown" where it cannot be read.
const std::string& program_build();

}  // namespace ft::inline baker
