#include <algorithm>

#include "baker/systems/cloth/cloth_kind.h"
#include "baker/systems/cords/cords_kind.h"
#include "baker/systems/system.h"

namespace ft {

std::span<const SystemKind* const> system_kinds() {
  static const SystemKind* const kinds[] = {
      cloth_kind(),
      cords_kind(),
  };
  return kinds;
}

const SystemKind* find_system_kind(std::string_view name) {
  const auto kinds = system_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const SystemKind* k) { return k->name() == name; });
  return found == kinds.end() ? nullptr : *found;
}

bool CachedBake::has_cache(const ManifestSystem& system) const {
  std::error_code error;
  return !system.caches.empty() && std::filesystem::exists(folder / system.caches[0].file, error);
}

}  // namespace ft
