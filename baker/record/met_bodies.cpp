#include "baker/record/met_bodies.h"

#include <algorithm>

namespace ft::inline baker {

Result<MetBodies> met_bodies(const CachedBake& bake, const ManifestSystem& system) {
  MetBodies out;
  out.missing = system.meets.empty() ? std::vector{system.primary} : system.meets;
  for (const ManifestSystem& other : bake.manifest.systems) {
    const auto met = std::find(out.missing.begin(), out.missing.end(), other.name);
    if (other.role != "body" || met == out.missing.end() || !bake.has_cache(other)) continue;
    auto body = bake.open(other);
    if (!body) return body.error();
    out.bodies.push_back(std::move(*body));
    out.missing.erase(met);
  }
  return out;
}

}  // namespace ft::inline baker
