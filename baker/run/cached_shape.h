// What a system of another shape than a mesh is in manifest, caches and beside them.
#pragma once

#include <filesystem>

#include "baker/record/manifest.h"
#include "io/cache/cache.h"

namespace ft::inline baker {

/// Its counts and prototypes.
void describe_shape(const SystemShape& shape, ManifestSystem& system);
/// Its rest data.
void fill_info(const SystemShape& shape, CacheInfo& info);
/// The prototypes as one OBJ, each a group of its name; nothing of what has none.
Status write_prototypes(const std::filesystem::path& path, const SystemShape& shape);

}  // namespace ft::inline baker
