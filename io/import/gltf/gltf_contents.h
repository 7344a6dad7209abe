// What a glTF holds and what becomes of it: refuses what it requires and cannot get, notes what changes the figure and
// is not evaluated, and lists everything for `info FILE`.
#pragma once

#include "io/import/gltf/gltf_file.h"

namespace ft::inline io::gltf {

/// Refuses an extension that the file requires and that is not read, by name.
Status check_required(const Json& json);
/// Fills contents, and notes for extensions in use that change shapes or motion and are not evaluated.
void describe_contents(const Json& json, const std::vector<int>& node_of, Character& out);

}  // namespace ft::inline io::gltf
