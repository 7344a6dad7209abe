// The scenes of the conformance table; each returns its rows. Listed in validation.cpp.
#pragma once

#include "solvers/validation/validation.h"

namespace ft::inline solvers {

// statics.cpp
std::vector<ValidationCase> validate_hanging_sheet();
std::vector<ValidationCase> validate_catenary();
std::vector<ValidationCase> validate_peirce();
std::vector<ValidationCase> validate_heavy_elastica();
// dynamics.cpp
std::vector<ValidationCase> validate_free_fall();
std::vector<ValidationCase> validate_free_flight();
std::vector<ValidationCase> validate_folding_flight();
std::vector<ValidationCase> validate_substep_invariance();
std::vector<ValidationCase> validate_terminal_velocity();
// swings.cpp
std::vector<ValidationCase> validate_pendulum_period();
std::vector<ValidationCase> validate_pendulum_energy();
std::vector<ValidationCase> validate_swing_at_default_settings();
std::vector<ValidationCase> validate_hanging_chain();
// friction.cpp
std::vector<ValidationCase> validate_incline();
std::vector<ValidationCase> validate_incline_inner_edge();
// couplings.cpp
std::vector<ValidationCase> validate_rope();
std::vector<ValidationCase> validate_prop_flight();
std::vector<ValidationCase> validate_mat();
std::vector<ValidationCase> validate_follow();
// winds.cpp
std::vector<ValidationCase> validate_hinged_panel();
std::vector<ValidationCase> validate_wake();

}  // namespace ft::inline solvers
