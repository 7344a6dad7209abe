#include "solvers/wind/registry.h"

#include <cmath>

#include "solvers/wind/grid_wind.h"
#include "solvers/wind/plain_flows.h"
#include "solvers/wind/turbulence.h"
#include "solvers/wind/uniform_wind.h"
#include "solvers/wind/wake.h"

namespace ft::inline solvers {
namespace {

constexpr WindFieldKind k_kinds[] = {
    {"uniform", UniformWind::make}, {"source", Source::make},   {"sink", Source::make_sink},
    {"vortex", Vortex::make},       {"doublet", Doublet::make}, {"turbulence", Turbulence::make},
    {"grid", GridWind::make},       {"wake", Wake::make},
};

/// All but the times, where infinity means that there is none.
bool is_finite(const WindFieldSpec& s) {
  for (const double value :
       {s.gain, s.fade, s.gusts, s.gust_time, s.flow, s.circulation, s.radius, s.intensity, s.length, s.turbulence})
    if (!std::isfinite(value)) return false;
  return s.velocity.allFinite() && s.position.allFinite() && s.axis.allFinite();
}

}  // namespace

std::span<const WindFieldKind> wind_field_kinds() {
  return k_kinds;
}

Result<std::unique_ptr<WindField>> make_wind_field(const WindFieldSpec& spec) {
  std::string names;
  for (const WindFieldKind& kind : k_kinds) {
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
    if (spec.kind != kind.name) continue;
    if (!is_finite(spec)) return usage_error("all numbers of a wind must be finite", spec.name);
    if (!(spec.fade >= 0)) return usage_error("fade must be 0 or more", spec.name);
    if (!(spec.until > spec.from)) return usage_error("until must come after from", spec.name);
    return kind.make(spec);
  }
  return usage_error("no wind is called \"" + spec.kind + "\"", spec.name, "one of " + names);
}

}  // namespace ft::inline solvers
