// Primaries from files. A character is imported by a child process with limits on time and memory (a bad file can
// corrupt memory), checked again here, cached under the hash of its bytes; a geometry cache is read directly.
#pragma once

#include <filesystem>

#include "baker/core/result.h"
#include "io/import/character/import_request.h"

namespace ft::inline io {

Result<ImportedPrimary> import_primary(const ImportRequest& request);
Result<CharacterInfo> inspect_character(const std::filesystem::path& file, const ImportLimits& limits = {});

/// The child's side: `followthrough --import-child IN OUT` ends here; returns the exit code. main() calls it before
/// anything else.
int import_child_main(int argc, char** argv);

}  // namespace ft::inline io
