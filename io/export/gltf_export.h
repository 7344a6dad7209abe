// A glTF file with other keys, for the animator: the original's JSON and bytes, members in their order, with new
// accessors behind them. What a changed channel pointed to before stays in the file, unused.
#pragma once

#include <filesystem>
#include <span>

#include "baker/core/bytes.h"
#include "io/import/character/motion_change.h"

namespace ft::inline io {

/// The bytes of a .glb: `source` (.glb, or .gltf with its buffers) with the changed channels of one clip. `character`
/// is what was imported from `source`; `clip` and nodes count in it. Without changes the copy of a .glb is the same
/// bytes. Buffers in other files or in data URIs become the .glb's own; images in other files, too, where they are PNG
/// or JPEG and can be read, and keep their URI otherwise. A node with a matrix gets translation, rotation and scale
/// when it is changed, as the format demands of what moves. Errors: a file that cannot be read or contradicts itself,
/// node trees that differ, more than 4 GiB, a changed node that the file does not have or whose matrix is sheared.
Result<Bytes> export_glb(const std::filesystem::path& source, const Character& character, int clip,
                         std::span<const ChangedChannel> changes);

}  // namespace ft::inline io
