#include "solvers/cloth/draw_back.h"

#include "solvers/cloth/candidates.h"
#include "solvers/cloth/cloth_model.h"

namespace ft {
namespace {

/// Softer than firm pins: N/m3 and Pa of the cloth's area.
constexpr double k_stiffness = 2e5, k_most_pull = 1e3;

}  // namespace

void DrawBack::follow(const ClothModel& model, const ClothMotion& cloth, const PieceMotion& piece,
                      std::span<const int> vertices, double h) {
  held_.clear();
  const std::size_t n = cloth.x.size();
  std::vector<Vec3> end;
  for (const int v : vertices) {
    if (end.empty()) {
      end.assign(piece.start.begin() + static_cast<std::ptrdiff_t>(n), piece.start.end());
      for (std::size_t b = 0; b < end.size(); ++b) end[b] += piece.body_motion[b];
    }
    const Vec3 from = model.absence.place_on_skin(v, std::span(piece.start).subspan(n)), to = model.absence.place_on_skin(v, end);
    PinPoint pin;
    pin.vertex = v;
    pin.stiffness = k_stiffness * model.contact.area[at(v)];
    pin.max_pull = k_most_pull * model.contact.area[at(v)];
    held_.push_back({v, PinPull(pin, cloth.x[at(v)], cloth.v[at(v)], to, to - from, h, 0)});
  }
}

double DrawBack::value(std::span<const Vec3> x) const {
  double energy = 0;
  for (const Held& held : held_) energy += held.pull.energy(x[at(held.vertex)]);
  return energy;
}

void DrawBack::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  for (const Held& held : held_) gradient[at(held.vertex)] += held.pull.gradient(x[at(held.vertex)]);
}

void DrawBack::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  for (const Held& held : held_)
    hessian.blocks[at(hessian.pattern->diagonal[at(held.vertex)])].diagonal().array() +=
        static_cast<float>(held.pull.stiffness(x[at(held.vertex)]));
}

}  // namespace ft
