// What an implicit step needs while it is solved, for the step and for what is measured at its end.
#pragma once

#include <optional>
#include <vector>

#include "baker/core/give_back.h"
#include "solvers/cloth/model/pin_pull.h"
#include "solvers/cloth/solve/implicit_step.h"
#include "solvers/cloth/solve/newton_direction.h"

namespace ft::inline solvers {

struct ImplicitStep::Scratch {
  explicit Scratch(const ClothModel& model) : newton(model) {}
  NewtonDirection newton;
  std::vector<PinPull> pins;
  std::vector<char> touches;  ///< per garment: whether the body has had a hold on it in this solve
  // Of a solve, and free while pairs are looked for.
  std::optional<ContactPotential> contact;
  std::vector<Vec3> gradient, trial;
  std::span<Vec3> y;  ///< where no force would bring the cloth [m]; velocities come in its place

  void forget_solve() {
    contact.reset();
    newton.forget_all();
    give_back(gradient, trial, y);
  }
};

/// Adds what the pins that count pull with at the end of the solve.
template <class Counts>
void ImplicitStep::add_pin_gradient(std::span<const Vec3> all, Counts&& counts) {
  Scratch& s = *scratch_;
  for (std::size_t p = 0; p < model_.pins.size(); ++p) {
    const PinPoint& pin = model_.pins[p];
    if (!s.pins[p].holds() || !counts(pin)) continue;
    s.gradient[at(pin.vertex)] += s.pins[p].gradient(all[at(pin.vertex)]);
  }
}

}  // namespace ft::inline solvers
