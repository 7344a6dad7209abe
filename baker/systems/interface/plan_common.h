// What all groups of a plan have in common, whatever their kind.
#pragma once

#include <memory>

#include "io/shot/shot.h"
#include "solvers/wind/wind.h"

namespace ft::inline baker {

/// Frames, forces and, where it has a choice, integrator of the shot into the setup of a solver.
template <class Setup>
void take_from_shot(const Shot& shot, const std::shared_ptr<const Wind>& wind, Setup& setup) {
  setup.first_frame = shot.first_frame;
  setup.fps = shot.fps;
  setup.preroll_frames = shot.preroll;
  setup.gravity = shot.solver.gravity;
  setup.wind = wind;
  if constexpr (requires { setup.min_substeps; }) setup.min_substeps = shot.solver.min_substeps;
  if constexpr (requires { setup.bdf2; }) setup.bdf2 = shot.solver.integrator == "bdf2";
}

}  // namespace ft::inline baker
