#include "solvers/cloth/cloth_motion.h"

#include <utility>

#include "baker/core/check.h"
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
  state.set("released", {m.released.begin(), m.released.end()});
  state.set("tangled", {m.tangled.begin(), m.tangled.end()});
}

ClothMotion take_motion(State& state, std::size_t count) {
  ClothMotion m;
  const auto take = [&](const char* name, std::size_t size, auto&& read) {
    const auto* values = state.find(name);
    CHECK(values && values->size() == size);
    read(*values);
    state.set(name, {});
  };
  for (const auto& [name, points] : {std::pair("x", &m.x),
                                     {"v", &m.v},
                                     {"x_previous", &m.x_previous},
                                     {"v_previous", &m.v_previous},
                                     {"x_older", &m.x_older},
                                     {"v_older", &m.v_older}})
    take(name, 3 * count, [points = points](const std::vector<double>& values) {
      const auto view = as_points(values);
      points->assign(view.begin(), view.end());
    });
  take("h_previous", 1, [&](const std::vector<double>& values) { m.h_previous = values[0]; });
  take("h_older", 1, [&](const std::vector<double>& values) { m.h_older = values[0]; });
  take("released", count, [&](const std::vector<double>& values) { m.released = {values.begin(), values.end()}; });
  take("tangled", count, [&](const std::vector<double>& values) { m.tangled = {values.begin(), values.end()}; });
  return m;
}

KeptMotion::KeptMotion(const ClothMotion& m)
    : x_(m.x), h_previous_(m.h_previous), h_older_(m.h_older), released_(m.released), tangled_(m.tangled) {
  const auto rounded = [](std::span<const Vec3> values) {
    std::vector<Vec3f> out(values.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = values[i].cast<float>();
    return out;
  };
  const auto from_x = [&](std::span<const Vec3> values) {
    std::vector<Vec3f> out(values.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = (values[i] - m.x[i]).cast<float>();
    return out;
  };
  v_ = rounded(m.v);
  v_previous_ = rounded(m.v_previous);
  v_older_ = rounded(m.v_older);
  to_previous_ = from_x(m.x_previous);
  to_older_ = from_x(m.x_older);
}

ClothMotion KeptMotion::motion() const {
  ClothMotion m;
  m.x = x_;
  const auto exact = [](std::span<const Vec3f> values, std::vector<Vec3> sum) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += values[i].cast<double>();
    return sum;
  };
  const std::vector<Vec3> zero(x_.size(), Vec3::Zero());
  m.v = exact(v_, zero);
  m.v_previous = exact(v_previous_, zero);
  m.v_older = exact(v_older_, zero);
  m.x_previous = exact(to_previous_, x_);
  m.x_older = exact(to_older_, x_);
  m.h_previous = h_previous_;
  m.h_older = h_older_;
  m.released = released_;
  m.tangled = tangled_;
  return m;
}

}  // namespace ft
