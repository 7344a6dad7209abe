// What kinds judge alike whose systems are judged one by one.
#pragma once

#include "baker/record/cache_track.h"
#include "baker/systems/interface/system.h"

namespace ft::inline baker {

/// Of the systems of a role that are cached and that `takes`: judge_one(system), or the error that ends it.
template <class Takes, class JudgeOne>
Result<std::vector<std::unique_ptr<JudgedGroup>>> judge_each(const CachedBake& bake, std::string_view role,
                                                             Takes&& takes, JudgeOne&& judge_one) {
  std::vector<std::unique_ptr<JudgedGroup>> out;
  for (const ManifestSystem& system : bake.manifest.systems) {
    if (system.role != role || !takes(system) || !bake.has_cache(system)) continue;
    auto one = judge_one(system);
    if (!one) return one.error();
    out.push_back(std::move(*one));
  }
  return out;
}

}  // namespace ft::inline baker
