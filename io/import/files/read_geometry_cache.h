// Reads geometry caches: Alembic, PC2 and MDD with an OBJ for the faces, or a numbered sequence of OBJ files (one alone
// is a prop that stands still). Read whole, in the file's own vertex order.
#pragma once

#include <filesystem>
#include <vector>

#include "baker/core/result.h"
#include "io/import/character/geometry_cache.h"

namespace ft::inline io {

/// By the file's extension.
bool is_geometry_cache(const std::filesystem::path& file);

/// Whether files of its kind say when their samples are; by the extension.
bool knows_its_times(const std::filesystem::path& file);

/// fps: samples per second (for MDD 0 means the file's own times). topology may be empty for OBJ; without it a PC2 or
/// MDD has no faces, which is an error unless faces_needed is false (info). With faces, vertices that stray for a few
/// samples are put back among their neighbours; points alone have to be finite.
Result<GeometryCache> read_geometry_cache(const std::filesystem::path& file, const std::filesystem::path& topology,
                                          double fps, bool faces_needed = true);

/// Files of a numbered sequence that `file` belongs to ("body_0001.obj", or "body_####.obj"), in order; one file alone
/// is itself.
Result<std::vector<std::filesystem::path>> numbered_sequence(const std::filesystem::path& file);

}  // namespace ft::inline io
