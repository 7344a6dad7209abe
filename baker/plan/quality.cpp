#include "baker/plan/quality.h"

#include <algorithm>

namespace ft::inline baker {

bool is_preview(const Shot& shot) {
  return shot.quality == "preview";
}

bool is_preview(const Manifest& manifest) {
  return std::ranges::any_of(manifest.settings, [](const auto& setting) {
    return setting.first == "shot.quality" && setting.second == "\"preview\"";
  });
}

std::string quality_note() {
  return "preview quality: a fifth of the vertices of each garment, and those of its seams, move and the others ride "
         "on them, about a body with fewer triangles, some millimetres thicker; crossings, gaps and strains are those "
         "of what moves";
}

}  // namespace ft::inline baker
