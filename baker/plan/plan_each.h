// What kinds plan alike whose sections are groups of their own each.
#pragma once

#include "baker/plan/plan.h"
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

}  // namespace ft::inline baker
