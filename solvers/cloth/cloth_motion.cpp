#include "solvers/cloth/cloth_motion.h"

#include "baker/core/state_points.h"

namespace ft {
void carry(const Teleport& teleport, ClothMotion& m) {
  carry(teleport, std::span(m.x));
  carry(teleport, std::span(m.x_previous));
  // The history is that of a cloth that always had the new velocity: BDF2 sees no step.
  const Vec3 step = m.h_previous * teleport.velocity_change;
  for (Vec3& x : m.x_previous) x -= step;
  for (auto* velocities : {&m.v, &m.v_previous})
    for (Vec3& v : *velocities) v = teleport.motion.linear() * v + teleport.velocity_change;
}

void store(State& state, const ClothMotion& m) {
  state.block("x") = flat(m.x);
  state.block("v") = flat(m.v);
  state.block("x_previous") = flat(m.x_previous);
  state.block("v_previous") = flat(m.v_previous);
  state.block("h_previous") = {m.h_previous};
  state.block("released") = m.released;
  state.block("tangled") = m.tangled;
}

ClothMotion load_motion(const State& state, std::size_t count) {
  ClothMotion m;
  m.x = points_of(state, "x", count);
  m.v = points_of(state, "v", count);
  m.x_previous = points_of(state, "x_previous", count);
  m.v_previous = points_of(state, "v_previous", count);
  const auto* h = state.find("h_previous");
  const auto* released = state.find("released");
  const auto* tangled = state.find("tangled");
  CHECK(h && h->size() == 1 && released && released->size() == count && tangled && tangled->size() == count);
  m.h_previous = h->front();
  m.released = *released;
  m.tangled = *tangled;
  return m;
}

}  // namespace ft
