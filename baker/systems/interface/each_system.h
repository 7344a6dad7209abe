// What kinds do alike whose sections are groups of their own each, and whose systems are judged one by one.
#pragma once

#include "baker/plan/plan.h"
#include "baker/record/cache_track.h"
#include "baker/systems/interface/system.h"

namespace ft::inline baker {

/// plan_one(spec, primary): a group, or the error that ends the planning.
template <class Spec, class PlanOne>
Result<SystemGroups> plan_each(const Shot& shot, const BakePlan& plan, PlanOne&& plan_one) {
  SystemGroups out;
  for (const Spec* spec : specs_of<Spec>(shot.secondaries))
    for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
      if (plan.primaries[p].name != spec->on) continue;
      auto group = plan_one(*spec, p);
      if (!group) return group.error();
      out.push_back(std::move(*group));
    }
  return out;
}

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
