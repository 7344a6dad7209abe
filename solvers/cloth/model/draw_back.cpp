#include "solvers/cloth/model/draw_back.h"

#include <algorithm>

#include "solvers/cloth/model/cloth_model.h"
#include "solvers/cloth/model/piece_motion.h"

namespace ft::inline solvers {
namespace {

/// As firm pins have it: N/m3 and Pa of the cloth's area.
constexpr double k_stiffness = 1e5, k_most_pull = 300;
/// Of what stays above the skin [N/m3].
constexpr double k_above_stiffness = 2e6;
/// In which what is inside loses its speed against the body [s].
constexpr double k_slowed = 2e-3;
/// Skin that is faster than this [m/s] takes nothing along: it is where the animation is broken. A pitcher's hand, the
/// fastest part of a body, comes to 40.
constexpr double k_fastest_skin = 50;

}  // namespace

void DrawBack::follow(const ClothModel& model, const ClothMotion& cloth, const PieceMotion& piece,
                      std::span<const SkinHold> holds, double h) {
  held_.clear();
  above_.clear();
  slowed_.clear();
  const std::size_t n = cloth.x.size();
  std::vector<Vec3> end;
  for (const SkinHold& hold : holds) {
    const int v = hold.vertex;
    const double area = model.contact.area[at(v)];
    if (hold.along >= 0 && piece.body_motion[at(hold.along)].norm() <= k_fastest_skin * h)
      slowed_.push_back({v, cloth.x[at(v)] + piece.body_motion[at(hold.along)], model.mass[at(v)] / (k_slowed * h)});
    if (!hold.to_skin) {
      if (hold.normal == Vec3::Zero()) continue;
      above_.push_back(
          {v, hold.normal, hold.normal.dot(hold.place) + model.contact.radius[at(v)], k_above_stiffness * area});
      continue;
    }
    if (end.empty()) {
      end.assign(piece.start.begin() + static_cast<std::ptrdiff_t>(n), piece.start.end());
      for (std::size_t b = 0; b < end.size(); ++b) end[b] += piece.body_motion[b];
    }
    const Vec3 from = model.absence.place_on_skin(v, std::span(piece.start).subspan(n));
    const Vec3 to = model.absence.place_on_skin(v, end);
    PinPoint pin;
    pin.vertex = v;
    pin.stiffness = k_stiffness * area;
    pin.max_pull = k_most_pull * area;
    held_.push_back({v, PinPull(pin, cloth.x[at(v)], cloth.v[at(v)], to, to - from, h, 0)});
  }
}

double DrawBack::value(std::span<const Vec3> x) const {
  double energy = 0;
  for (const Held& held : held_) energy += held.pull.energy(x[at(held.vertex)]);
  for (const Slowed& s : slowed_) energy += 0.5 * s.stiffness * (x[at(s.vertex)] - s.place).squaredNorm();
  for (const Above& a : above_) {
    const double missing = std::max(0.0, a.height - a.normal.dot(x[at(a.vertex)]));
    energy += 0.5 * a.stiffness * missing * missing;
  }
  return energy;
}

void DrawBack::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  for (const Held& held : held_) gradient[at(held.vertex)] += held.pull.gradient(x[at(held.vertex)]);
  for (const Slowed& s : slowed_) gradient[at(s.vertex)] += s.stiffness * (x[at(s.vertex)] - s.place);
  for (const Above& a : above_)
    gradient[at(a.vertex)] -= a.stiffness * std::max(0.0, a.height - a.normal.dot(x[at(a.vertex)])) * a.normal;
}

void DrawBack::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  for (const Held& held : held_)
    hessian.blocks[at(hessian.pattern->diagonal[at(held.vertex)])].diagonal().array() +=
        static_cast<float>(held.pull.stiffness(x[at(held.vertex)]));
  for (const Slowed& s : slowed_)
    hessian.blocks[at(hessian.pattern->diagonal[at(s.vertex)])].diagonal().array() += static_cast<float>(s.stiffness);
  for (const Above& a : above_)
    if (a.normal.dot(x[at(a.vertex)]) < a.height)
      hessian.blocks[at(hessian.pattern->diagonal[at(a.vertex)])] +=
          (a.stiffness * a.normal * a.normal.transpose()).cast<float>();
}

}  // namespace ft::inline solvers
