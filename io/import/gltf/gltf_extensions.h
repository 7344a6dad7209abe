// The extensions of glTF that are known here, and what becomes of each.
#pragma once

#include <string>

namespace ft::inline io::gltf {

enum class ExtensionUse {
  k_read,        ///< changes shapes or motion, and is read
  k_appearance,  ///< says how things look, sound or are described: bodies are the same without it
  k_not_used,    ///< changes shapes or motion and is not evaluated: a note, a refusal where the file requires it
  k_unknown,     ///< nobody here knows; a note, a refusal where the file requires it
};

ExtensionUse extension_use(const std::string& name);

}  // namespace ft::inline io::gltf
