#include "baker/systems/cords/cords_group.h"

#include <fmt/format.h>

#include "io/shot/shot_values.h"
#include "io/shot/words.h"

namespace ft::inline baker {

std::vector<std::string> CordsGroup::lines(const BakePlan& plan) const {
  std::vector<std::string> out;
  for (std::size_t c = 0; c < setup.cords.size(); ++c) {
    const CordSystem& cords = setup.cords[c];
    out.push_back(fmt::format("cords \"{}\" on \"{}\": {} points, {} cords, {} held, {:g} kg, EA = {:g} N{}",
                              cords.name, plan.primaries[primary].name, cords.graph.points.size(),
                              cords.graph.cords.size(), cords.graph.held.size(), cords.mass, cords.stretch,
                              setup.prop && setup.prop->two_way ? ", two-way" : ""));
    if (plan.primaries.size() == 1) continue;
    std::vector<std::string> names;
    if (setup.prop) names.push_back(in_quotes(setup.prop->name));
    for (const MetBody& body : setup.bodies)
      if (body.met_by[c] != 0) names.push_back(in_quotes(body.name));
    out.push_back("  meets " + joined(names) + (names.size() == 1 ? " alone" : ""));
  }
  return out;
}

/// All of them are met as they are drawn.
std::vector<ColliderSlice> CordsGroup::slices(const BakePlan& plan, std::span<const std::string>) const {
  std::vector<ColliderSlice> out;
  if (bodies.empty()) return out;
  if (setup.prop)
    out.push_back(
        {.primary = primary, .name = plan.primaries[primary].name, .fixed = true, .vertices = {}, .triangles = {}});
  for (std::size_t b = 0; b < bodies.size(); ++b)
    out.push_back({.primary = bodies[b],
                   .name = setup.bodies[b].name,
                   .fixed = true,
                   .vertices = {},
                   .triangles = {},
                   .met_by = setup.bodies[b].met_by});
  return out;
}

}  // namespace ft::inline baker
