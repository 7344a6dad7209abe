#include "baker/record/met_bodies.h"

#include <algorithm>

namespace ft::inline baker {

Result<MetBodies> met_bodies(const CachedBake& bake, const ManifestSystem& system) {
  MetBodies out;
  out.missing = system.meets.empty() ? std::vector{system.primary} : system.meets;
  for (const ManifestSystem& other : bake.manifest.systems) {
    const std::string called = other.role == "body" ? other.name : other.role + "." + other.name;
    const auto met = std::find(out.missing.begin(), out.missing.end(), called);
    if (met == out.missing.end() || !bake.has_cache(other)) continue;
    auto body = bake.open(other);
    if (!body) return body.error();
    if (other.role != "body") body->sheet = true;  // only cloth carries others
    out.bodies.push_back(std::move(*body));
    out.missing.erase(met);
  }
  return out;
}

}  // namespace ft::inline baker
