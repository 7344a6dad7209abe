#include "baker/plan/drawn_group.h"

#include <fmt/format.h>

#include "baker/plan/meets.h"
#include "io/shot/words.h"

namespace ft::inline baker {

std::vector<ColliderSlice> DrawnGroup::slices(const BakePlan& plan, std::span<const std::string>) const {
  std::vector<ColliderSlice> out;
  for (const std::size_t p : meets)
    out.push_back({.primary = p, .name = plan.primaries[p].name, .fixed = true, .vertices = {}, .triangles = {}});
  return out;
}

std::string DrawnGroup::met_names(const BakePlan& plan) const {
  std::vector<std::string> out;
  for (const std::size_t p : meets) out.push_back(in_quotes(plan.primaries[p].name));
  return joined(out);
}

Status find_met(const SecondarySpec& spec, std::span<const std::string> patterns, BakePlan& plan,
                std::vector<std::size_t>& meets) {
  const auto named = meets_of(patterns, spec.on, plan.primaries);
  if (!named) return named.error();
  for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
    const PrimaryPlan& primary = plan.primaries[p];
    if ((*named)[p] == 0) continue;
    if (const std::string why = why_alone(plan.shot(), primary); !why.empty())
      plan.notes.push_back(fmt::format("{} does not meet \"{}\": {}", spec.owner(), primary.name, why));
    else
      meets.push_back(p);
  }
  return {};
}

}  // namespace ft::inline baker
