#include "solvers/hair/hair_setup.h"

namespace ft::inline solvers {

namespace {

/// A strand as caches have it.
struct CachedStrand {
  std::span<const Vec3> positions;
  double width = 0;
  std::uint64_t id = 0;
  int held = 1;
};

SystemShape curves(const std::string& name, std::span<const CachedStrand> strands, bool are_guides) {
  SystemShape out;
  out.name = name;
  out.content.shape = OutputShape::k_curves;
  std::vector<std::int32_t> ids;
  std::vector<std::int16_t> guides, held;
  for (const CachedStrand& strand : strands) {
    out.curves.vertices_per_curve.push_back(static_cast<int>(strand.positions.size()));
    out.curves.rest.insert(out.curves.rest.end(), strand.positions.begin(), strand.positions.end());
    out.curves.widths.push_back(static_cast<float>(strand.width));
    out.curves.ids.push_back(strand.id);
    ids.push_back(static_cast<std::int32_t>(strand.id));
    guides.push_back(are_guides ? 1 : 0);
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

}  // namespace

SystemShape curves_of(const HairSetup& setup) {
  std::vector<CachedStrand> all;
  for (const HairStrand& s : setup.strands) all.push_back({s.positions, s.width, s.id, s.held});
  return curves(setup.name, all, true);
}

SystemShape curves_between(const HairSetup& setup) {
  std::vector<CachedStrand> all;
  for (const BetweenStrand& s : setup.between) all.push_back({s.positions, s.width, all.size(), 1});
  return curves(setup.name + "_strands", all, false);
}

}  // namespace ft::inline solvers
