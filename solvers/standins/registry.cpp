#include "solvers/standins/registry.h"

#include <cmath>

#include "solvers/standins/carried_weight.h"
#include "solvers/standins/fitted_field.h"
#include "solvers/standins/spring_grid.h"
#include "solvers/standins/unilateral_spring.h"
#include "solvers/standins/water_plane.h"

namespace ft::inline solvers {
namespace {

constexpr StandInKind k_kinds[] = {
    {"damping", DampingVolume::make},   {"mat", SpringGrid::make},       {"water", WaterPlane::make},
    {"spring", UnilateralSpring::make}, {"weight", CarriedWeight::make}, {"fitted", FittedField::make},
};

/// All but the times and the largest force, where infinity means that there is none.
bool is_finite(const StandInSpec& s) {
  for (const double value :
       {s.gain, s.heading, s.radius_top, s.radius_bottom, s.height, s.soft_edge, s.damping, s.damping_quadratic,
        s.damping_spin, s.stiffness, s.stiffness_cubic, s.damping_ratio, s.density, s.drag, s.slam, s.length, s.mass})
    if (!std::isfinite(value)) return false;
  const Vec3 places[] = {s.position, s.size, s.damping_axes, s.anchor};
  return all_finite(places) && all_finite(s.mesh.positions);
}

}  // namespace

std::span<const StandInKind> stand_in_kinds() {
  return k_kinds;
}

Result<std::unique_ptr<StandIn>> make_stand_in(const StandInSpec& spec) {
  std::string names;
  for (const StandInKind& kind : k_kinds) {
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
    if (spec.kind != kind.name) continue;
    if (!is_finite(spec)) return usage_error("all numbers of a stand-in must be finite", spec.name);
    if (!(spec.gain >= 0)) return usage_error("gain must be 0 or more", spec.name);
    if (!(spec.until > spec.from)) return usage_error("until must come after from", spec.name);
    if (!(spec.limit_force > 0)) return usage_error("limit_force must be above 0", spec.name);
    if (!(spec.soft_edge >= 0)) return usage_error("soft_edge must be 0 or more", spec.name);
    auto made = kind.make(spec);
    if (!made) return made;
    const bool supporting = (*made)->is_supporting();
    if (supporting && spec.support == Support::k_add)
      return usage_error("a stand-in of kind \"" + spec.kind +
                             "\" holds the body up, and so does the ground that the clip was made on: added to that it "
                             "would never be touched, or hold the body twice",
                         spec.name, "support = \"replace\"");
    if (!supporting && spec.support == Support::k_replace)
      return usage_error("a stand-in of kind \"" + spec.kind + "\" cannot hold the body up in place of the ground",
                         spec.name, "support = \"add\"");
    return made;
  }
  return usage_error("no stand-in is called \"" + spec.kind + "\"", spec.name, "one of " + names);
}

}  // namespace ft::inline solvers
