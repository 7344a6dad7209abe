#include "solvers/validation/validation.h"

#include <cmath>

#include "solvers/validation/scenes.h"

namespace ft::inline solvers {
namespace {

constexpr ValidationScene k_scenes[] = {
    {"hanging_sheet", "A sheet hung by its upper edge stretches by rho g H^2 / 2E at any resolution", true,
     validate_hanging_sheet},
    {"catenary", "An inextensible strip between two points hangs as a catenary", true, validate_catenary},
    {"peirce_cantilever", "A strip of Peirce's bending length droops to 41.5 degrees", true, validate_peirce},
    {"heavy_elastica", "A cantilever under its own weight follows the elastica", true, validate_heavy_elastica},
    {"free_fall", "Cloth falls freely in vacuum", false, validate_free_fall},
    {"free_flight", "A sheet in free flight keeps its momentum and angular momentum", true, validate_free_flight},
    {"folding_flight", "A sheet that folds onto itself in free flight keeps them too", true, validate_folding_flight},
    {"substep_invariance", "Halving the substep divides the error by four", false, validate_substep_invariance},
    {"terminal_velocity", "A stiff square falls flat in air with rho Cn A v^2 / 2 = m g", false,
     validate_terminal_velocity},
    {"pendulum_period", "The period of a pendulum grows with its amplitude as the elliptic integral", true,
     validate_pendulum_period},
    {"pendulum_energy", "A pendulum keeps its energy for a minute", true, validate_pendulum_energy},
    {"swing_at_default_settings", "A swinging strip keeps period and energy at the settings of a bake", true,
     validate_swing_at_default_settings},
    {"hanging_chain", "The first mode of a hanging strip is that of Bernoulli's chain", true, validate_hanging_chain},
    {"incline", "Cloth on an incline sticks and slides by Coulomb's law", true, validate_incline},
    {"incline_inner_edge", "Sliding over an edge between two triangles of a flat slab is not slowed", false,
     validate_incline_inner_edge},
    {"rope", "A rope hangs as a catenary, and its ends hold its weight", true, validate_rope},
    {"prop_flight", "A thrown box flies and spins as a free body", false, validate_prop_flight},
    {"mat", "Who stands on a mat in a hybrid pass sinks by m g / k", false, validate_mat},
    {"follow", "What follows on a spring is the damped oscillator, whatever the step", false, validate_follow},
    {"hinged_panel", "A hinged stiff panel hangs in the wind where its weight balances the drag", false,
     validate_hinged_panel},
    {"wake", "Through every plane behind a body goes the momentum of its drag", false, validate_wake},
};

}  // namespace

ValidationCase validation_case(std::string name, std::string what, double value, double reference, double tolerance,
                               std::string unit, std::string source) {
  ValidationCase out;
  out.name = std::move(name), out.what = std::move(what), out.unit = std::move(unit), out.source = std::move(source);
  out.value = value, out.reference = reference, out.tolerance = tolerance;
  out.passed = std::abs(value - reference) <= tolerance;  // false for NaN
  return out;
}

std::span<const ValidationScene> validation_scenes() {
  return k_scenes;
}

std::vector<ValidationCase> run_validation(std::string_view filter,
                                           const std::function<void(const ValidationScene&)>& before) {
  std::vector<ValidationCase> out;
  for (const ValidationScene& scene : k_scenes) {
    if (scene.name.find(filter) == std::string_view::npos) continue;
    if (before) before(scene);
    auto rows = scene.run();
    out.insert(out.end(), std::make_move_iterator(rows.begin()), std::make_move_iterator(rows.end()));
  }
  return out;
}

}  // namespace ft::inline solvers
