// The solver of a primary that has no secondaries to be baked: nothing moves but the time. So that its adjusted motion
// is walked, cached and resumed as everything else.
#pragma once

#include <memory>

#include "solvers/solver.h"

namespace ft {

/// fps > 0.
std::unique_ptr<Solver> make_body_only(int first_frame, int preroll_frames, double fps);

}  // namespace ft
