#include "solvers/cloth/model/first_state.h"

#include "solvers/cloth/model/sewing.h"

namespace ft::inline solvers {

State first_state(const ClothModel& model, const std::vector<char>& tangled) {
  State state;
  const ClothSetup& setup = model.setup;
  state.frame = setup.first_frame - setup.preroll_frames;
  state.time = -setup.preroll_frames / setup.fps;
  ClothMotion m;
  const std::span<const Vec3> x = model.start.empty() ? model.contact.rest : model.start;
  m.x.assign(x.begin(), x.end());
  m.v.assign(m.x.size(), Vec3::Zero());
  if (model.collider) {
    std::vector<Vec3> drawn, feasible;
    std::vector<char> deep;
    model.collider->drawn(state.time, drawn);
    model.collider->feasible(state.time, drawn, feasible, &deep);
    m.absent = model.absence.at_start(deep);
  }
  m.tangled = tangled;
  m.tangled.resize(m.x.size(), 0);
  // A history of constant acceleration makes the integrator exact for free fall from the first step on.
  const double h = 1.0 / (setup.fps * setup.min_substeps);
  m.x_previous = m.x_older = m.x;
  m.v_previous = m.v_older = m.v;
  for (std::size_t i = 0; i < m.x.size(); ++i) {
    if (model.unused[i]) continue;
    m.x_previous[i] += 0.5 * h * h * setup.gravity;
    m.v_previous[i] -= h * setup.gravity;
    m.x_older[i] += 2 * h * h * setup.gravity;
    m.v_older[i] -= 2 * h * setup.gravity;
  }
  for (const PinPoint& pin : model.pins) {
    if (pin.hold.share(state.time) == 0) continue;
    m.x_previous[at(pin.vertex)] = m.x_older[at(pin.vertex)] = m.x[at(pin.vertex)];
    m.v_previous[at(pin.vertex)] = m.v_older[at(pin.vertex)] = m.v[at(pin.vertex)];
  }
  // Nor does cloth that is still to be sewn fall.
  std::vector<Vec3> eased(m.x.size(), Vec3::Zero());
  if (ease_sewing(model, state.time, std::vector<Vec3>(m.x.size(), Vec3::Zero()), eased))
    for (std::size_t i = 0; i < m.x.size(); ++i)
      if (eased[i] != Vec3::Zero()) m.x_previous[i] = m.x_older[i] = m.x[i], m.v_previous[i] = m.v_older[i] = m.v[i];
  m.h_previous = m.h_older = h;
  store(state, m);
  return state;
}

}  // namespace ft::inline solvers
