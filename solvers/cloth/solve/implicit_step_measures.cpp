// What a solved step did to the bodies, and what it left over.
#include <algorithm>

#include "solvers/cloth/solve/forces_on_bodies.h"
#include "solvers/cloth/solve/implicit_step_scratch.h"

namespace ft::inline solvers {

/// From what moves the garments, not from the contacts' forces: those are what Newton was after, and until it has
/// settled the cloth gets less of them. What is left of a garment's change of momentum after gravity, air and other
/// garments and what holds it to the world came from the body.
void ImplicitStep::measure_on_body(std::span<const Vec3> all, double inertia, StepResult& result) {
  Scratch& s = *scratch_;
  const std::size_t garments = model_.setup.garments.size(), n = s.y.size();
  result.on_body.resize(garments * model_.body_count());
  if (std::none_of(s.touches.begin(), s.touches.end(), [](char c) { return c != 0; })) return;
  const std::span<const Vec3> x = all.first(n);
  s.gradient.assign(n, Vec3::Zero());
  for (const auto& energy : model_.energies)
    if (!energy->is_internal()) energy->add_gradient(x, s.gradient);
  if (garments > 1) s.contact->add_gradient_between_garments(all, s.gradient);
  add_pin_gradient(all, [](const PinPoint& pin) { return pin.to_world; });
  std::vector<Wrench> total(garments);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t g = at(model_.contact.garment[i]);
    if (s.touches[g] != 0) total[g].add(x[i], -(model_.mass[i] * inertia * (x[i] - s.y[i]) + s.gradient[i]));
  }
  result.on_body = model_.setup.bodies.empty() ? total : share_out(total, told_by_contacts(all), wearer_bodies(model_));
}

/// What contacts and pins press on each of several bodies with.
std::vector<Wrench> ImplicitStep::told_by_contacts(std::span<const Vec3> all) {
  Scratch& s = *scratch_;
  const std::size_t n = s.y.size(), bodies = model_.body_count();
  std::vector<Wrench> out(model_.setup.garments.size() * bodies);
  for (std::size_t b = 0; b < bodies; ++b) {
    s.gradient.assign(n, Vec3::Zero());
    s.contact->add_gradient_with_body(all, static_cast<int>(b), model_.body_of_vertex, s.gradient);
    add_pin_gradient(all, [&](const PinPoint& pin) {
      return pin.triangle[0] >= 0 && at(model_.body_of_vertex[at(pin.triangle[0])]) == b;
    });
    for (std::size_t i = 0; i < n; ++i)
      if (s.gradient[i] != Vec3::Zero()) out[at(model_.contact.garment[i]) * bodies + b].add(all[i], s.gradient[i]);
  }
  return out;
}

/// What is left of the gradient of a whole garment: inner forces cancel out, and all others have to make its momentum.
void ImplicitStep::measure_lost(std::span<const Vec3> all, double inertia, StepResult& result) {
  const double gravity = model_.setup.gravity.norm();
  if (model_.attachments.empty() || !(gravity > 0)) return;
  Scratch& s = *scratch_;
  const std::span<const Vec3> x = all.first(s.y.size());
  s.gradient.assign(s.y.size(), Vec3::Zero());
  for (const auto& energy : model_.energies)
    if (!energy->is_internal()) energy->add_gradient(x, s.gradient);
  s.contact->add_gradient(all, s.gradient);
  add_pin_gradient(all, [](const PinPoint&) { return true; });
  std::vector<char> attached(model_.setup.garments.size(), 0);
  for (const AttachPoint& point : model_.attachments) attached[at(model_.garment_of(point.vertex))] = 1;
  for (std::size_t g = 0; g < attached.size(); ++g) {
    if (attached[g] == 0) continue;
    Vec3 left = Vec3::Zero();
    double mass = 0;
    for (auto i = at(model_.first_vertex[g]); i < at(model_.first_vertex[g + 1]); ++i) {
      left += model_.mass[i] * inertia * (x[i] - s.y[i]) + s.gradient[i];
      mass += model_.mass[i];
    }
    result.lost_weight = std::max(result.lost_weight, left.norm() / (mass * gravity));
  }
}

}  // namespace ft::inline solvers
