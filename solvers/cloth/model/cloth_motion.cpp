#include "solvers/cloth/model/cloth_motion.h"

#include <algorithm>

#include "baker/core/check.h"
#include "baker/core/state_points.h"

namespace ft::inline solvers {
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
  // As a length and the places where it changes.
  std::vector<double> changes{static_cast<double>(m.absent.size())};
  for (std::size_t k = 0; k < m.absent.size(); ++k)
    if (m.absent[k] != (k == 0 ? 0 : m.absent[k - 1])) changes.push_back(static_cast<double>(k));
  state.set("absent", std::move(changes));
  state.set("tangled", {m.tangled.begin(), m.tangled.end()});
}

ClothMotion take_motion(State& state, std::size_t count) {
  const auto points = [&](std::string_view name) {
    std::vector<Vec3> out = points_of(state, name, count);
    state.set(name, {});
    return out;
  };
  const auto numbers = [&](std::string_view name, std::size_t size) {
    const auto* values = state.find(name);
    CHECK(values && values->size() == size);
    std::vector<double> out = *values;
    state.set(name, {});
    return out;
  };
  ClothMotion m;
  m.x = points("x");
  m.v = points("v");
  m.x_previous = points("x_previous");
  m.v_previous = points("v_previous");
  m.x_older = points("x_older");
  m.v_older = points("v_older");
  m.h_previous = numbers("h_previous", 1)[0];
  m.h_older = numbers("h_older", 1)[0];
  m.absent = absent_of(state);
  state.set("absent", {});
  for (const double is : numbers("tangled", count)) m.tangled.push_back(static_cast<char>(is));
  return m;
}

std::vector<char> absent_of(const State& state) {
  const auto* values = state.find("absent");
  CHECK(values && !values->empty());
  std::vector<char> out(static_cast<std::size_t>(values->front()), 0);
  for (std::size_t k = 1; k < values->size(); k += 2) {
    const double end = k + 1 < values->size() ? (*values)[k + 1] : values->front();
    for (auto i = static_cast<std::size_t>((*values)[k]); i < static_cast<std::size_t>(end); ++i) out[i] = 1;
  }
  return out;
}

KeptMotion::KeptMotion(const ClothMotion& m) : x_(m.x), h_previous_(m.h_previous), absent_(m.absent) {
  if (std::any_of(m.tangled.begin(), m.tangled.end(), [](char is) { return is != 0; })) tangled_ = m.tangled;
  const auto from = [](std::span<const Vec3> origin, std::span<const Vec3> values) {
    std::vector<Vec3f> out(values.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = (values[i] - origin[i]).cast<float>();
    return out;
  };
  const std::vector<Vec3> zero(x_.size(), Vec3::Zero());
  v_ = from(zero, m.v);
  v_previous_ = from(zero, m.v_previous);
  to_previous_ = from(x_, m.x_previous);
}

ClothMotion KeptMotion::motion() const {
  const auto back = [](std::vector<Vec3> origin, std::span<const Vec3f> values) {
    for (std::size_t i = 0; i < origin.size(); ++i) origin[i] += values[i].cast<double>();
    return origin;
  };
  const std::vector<Vec3> zero(x_.size(), Vec3::Zero());
  ClothMotion m;
  m.x = x_;
  m.v = back(zero, v_);
  m.v_previous = back(zero, v_previous_);
  m.x_previous = back(x_, to_previous_);
  m.x_older = m.x_previous;
  m.v_older = m.v_previous;
  m.h_previous = h_previous_;
  m.absent = absent_;
  m.tangled = tangled_;
  m.tangled.resize(x_.size(), 0);
  return m;
}

void take_along_with(const Vec3& way, const Vec3& velocity, ClothMotion& m) {
  for (Vec3& x : m.x) x += way;
  m.x_previous = m.x_older = m.x;
  std::fill(m.v.begin(), m.v.end(), velocity);
  m.v_previous = m.v_older = m.v;
  m.h_previous = m.h_older = 0;
  std::fill(m.absent.begin(), m.absent.end(), char{1});
}

}  // namespace ft::inline solvers
