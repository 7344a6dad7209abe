#include "solvers/hair/hair_setup.h"

namespace ft::inline solvers {

SystemShape curves_of(const HairSetup& setup) {
  SystemShape out;
  out.name = setup.name;
  out.content.shape = OutputShape::k_curves;
  std::vector<std::int32_t> ids;
  std::vector<std::int16_t> guides, held;
  for (const HairStrand& strand : setup.strands) {
    out.curves.vertices_per_curve.push_back(static_cast<int>(strand.positions.size()));
    out.curves.rest.insert(out.curves.rest.end(), strand.positions.begin(), strand.positions.end());
    out.curves.widths.push_back(static_cast<float>(strand.width));
    out.curves.ids.push_back(strand.id);
    ids.push_back(static_cast<std::int32_t>(strand.id));
    guides.push_back(1);
    held.push_back(static_cast<std::int16_t>(strand.held));
  }
  out.attributes = {
      {"groom_version_major", AttributeScope::k_all, std::vector<std::int16_t>{1}},
      {"groom_version_minor", AttributeScope::k_all, std::vector<std::int16_t>{5}},
      {"groom_tool", AttributeScope::k_all, std::vector<std::string>{"Followthrough"}},
      {"groom_id", AttributeScope::k_each, std::move(ids)},
      {"groom_guide", AttributeScope::k_each, std::move(guides)},
      {k_held, AttributeScope::k_each, std::move(held)},
      {"groom_width", AttributeScope::k_each, out.curves.widths},
  };
  return out;
}

}  // namespace ft::inline solvers
