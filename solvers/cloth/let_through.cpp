#include "solvers/cloth/let_through.h"

#include "solvers/cloth/candidates.h"
#include "solvers/cloth/cloth_model.h"

namespace ft {
namespace {

/// In which the drag stops what moves freely [s]: gravity alone makes it creep by 1 mm/s, a fold that springs open by
/// some mm/s, stretched cloth moves all the same.
constexpr double k_drag_time = 1e-4;
/// Parts that are farther away than this do not hold the cloth [m].
constexpr double k_farthest = 0.05;

}  // namespace

void LetThroughDrag::follow(const ClothModel& model, const ClothMotion& cloth, const PieceMotion& piece) {
  held_.clear();
  Box box;
  for (std::size_t i = 0; i < cloth.x.size(); ++i)
    if (cloth.released[i] >= 0) held_.push_back({static_cast<int>(i), cloth.x[i]}), box.include(cloth.x[i]);
  if (held_.empty()) return;
  box.inflate(k_farthest);
  const std::size_t nc = cloth.x.size();
  const auto parts = model.collider->part_of_vertex();
  std::vector<int> near;  // body vertices
  for (std::size_t b = 0; b < piece.body_motion.size(); ++b) {
    const Vec3& p = piece.start[nc + b];
    if ((p.array() >= box.lo.array()).all() && (p.array() <= box.hi.array()).all()) near.push_back(static_cast<int>(b));
  }
  std::erase_if(held_, [&](Held& held) {
    const Vec3& p = cloth.x[at(held.vertex)];
    double nearest = k_farthest * k_farthest;
    int holder = -1;
    for (const int b : near) {
      if (model.may_pass(cloth.released[at(held.vertex)], parts[at(b)])) continue;
      const double d2 = (piece.start[nc + at(b)] - p).squaredNorm();
      if (d2 < nearest) nearest = d2, holder = b;
    }
    if (holder >= 0) held.place = p + piece.body_motion[at(holder)];
    return holder < 0;
  });
}

double LetThroughDrag::stiffness(int vertex) const {
  return mass_[at(vertex)] / (k_drag_time * h_);
}

double LetThroughDrag::value(std::span<const Vec3> x) const {
  double energy = 0;
  for (const Held& held : held_)
    energy += 0.5 * stiffness(held.vertex) * (x[at(held.vertex)] - held.place).squaredNorm();
  return energy;
}

void LetThroughDrag::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  for (const Held& held : held_)
    gradient[at(held.vertex)] += stiffness(held.vertex) * (x[at(held.vertex)] - held.place);
}

void LetThroughDrag::add_hessian(std::span<const Vec3>, BlockMatrix& hessian) const {
  for (const Held& held : held_)
    hessian.blocks[at(hessian.pattern->diagonal[at(held.vertex)])].diagonal().array() +=
        static_cast<float>(stiffness(held.vertex));
}

}  // namespace ft
