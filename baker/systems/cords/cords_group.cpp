#include "baker/systems/cords/cords_group.h"

#include <fmt/format.h>

namespace ft::inline baker {

std::vector<std::string> CordsGroup::lines(const BakePlan& plan) const {
  std::vector<std::string> out;
  for (const CordSystem& c : setup.cords)
    out.push_back(fmt::format("cords \"{}\" on \"{}\": {} points, {} cords, {} held, {:g} kg, EA = {:g} N{}", c.name,
                              plan.primaries[primary].name, c.graph.points.size(), c.graph.cords.size(),
                              c.graph.held.size(), c.mass, c.stretch, setup.prop->two_way ? ", two-way" : ""));
  return out;
}

}  // namespace ft::inline baker
