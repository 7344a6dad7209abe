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
  state.set("x", flat(m.x));
  state.set("v", flat(m.v));
  state.set("x_previous", flat(m.x_previous));
  state.set("v_previous", flat(m.v_previous));
  state.set("x_older", flat(m.x_older));
  state.set("v_older", flat(m.v_older));
  state.set("h_previous", {m.h_previous});
  state.set("h_older", {m.h_older});
  state.set("released", m.released);
  state.set("tangled", m.tangled);
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
