#include "solvers/cloth/cloth_motion.h"

#include "baker/core/state_points.h"

namespace ft {
void carry(const Teleport& teleport, ClothMotion& m) {
  carry(teleport, std::span(m.x));
  carry(teleport, std::span(m.x_previous));
  carry(teleport, std::span(m.x_older));
  // The history is that of a cloth that always had the new velocity: the integrator sees no step.
  for (Vec3& x : m.x_previous) x -= m.h_previous * teleport.velocity_change;
  for (Vec3& x : m.x_older) x -= (m.h_previous + m.h_older) * teleport.velocity_change;
  for (auto* velocities : {&m.v, &m.v_previous, &m.v_older})
    for (Vec3& v : *velocities) v = teleport.motion.linear() * v + teleport.velocity_change;
}

void store(State& state, const ClothMotion& m) {
  state.block("x") = flat(m.x);
  state.block("v") = flat(m.v);
  state.block("x_previous") = flat(m.x_previous);
  state.block("v_previous") = flat(m.v_previous);
  state.block("x_older") = flat(m.x_older);
  state.block("v_older") = flat(m.v_older);
  state.block("h_previous") = {m.h_previous};
  state.block("h_older") = {m.h_older};
  state.block("released") = m.released;
  state.block("tangled") = m.tangled;
}

ClothMotion load_motion(const State& state, std::size_t count) {
  ClothMotion m;
  m.x = points_of(state, "x", count);
  m.v = points_of(state, "v", count);
  m.x_previous = points_of(state, "x_previous", count);
  m.v_previous = points_of(state, "v_previous", count);
  m.x_older = points_of(state, "x_older", count);
  m.v_older = points_of(state, "v_older", count);
  const auto* h = state.find("h_previous");
  const auto* older = state.find("h_older");
  const auto* released = state.find("released");
  const auto* tangled = state.find("tangled");
  CHECK(h && h->size() == 1 && older && older->size() == 1 && released && released->size() == count && tangled &&
        tangled->size() == count);
  m.h_previous = h->front();
  m.h_older = older->front();
  m.released = *released;
  m.tangled = *tangled;
  return m;
}

}  // namespace ft
