// What a guarded child is at: one line in a file, written before each step, so that it is there however the process
// ends and the parent can say what crashed on what. In a process that is no such child it does nothing.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace ft::inline io {

/// "the meshes, with assimp": completes "crashed while reading ...". The first 200 bytes count.
void reading_step(std::string_view what);

/// From here on steps of this process go into the file.
void keep_reading_steps(const std::filesystem::path& file);

/// The last step that a process kept; empty: none. Printable, whatever the file holds.
std::string last_reading_step(const std::filesystem::path& file);

}  // namespace ft::inline io
