// How a file's name ends, whatever the case.
#pragma once

#include <filesystem>
#include <string>

namespace ft::inline io {

/// ".fbx" of "a.FBX"; empty without an extension. Only A to Z are made small.
inline std::string lower_extension(const std::filesystem::path& file) {
  std::string out = file.extension().string();
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

}  // namespace ft::inline io
