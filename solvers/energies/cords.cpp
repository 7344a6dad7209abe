#include "solvers/energies/cords.h"

#include "solvers/energies/limited_spring.h"

namespace ft::inline solvers {
namespace {

constexpr double k_no_length = 1e-12;  ///< a cord shorter than this has no direction [m]

/// From the second end to the first [m].
Vec3 gap(const Cord& c, std::span<const Vec3> x) {
  Vec3 d = x[at(c.vertex[0])];
  for (std::size_t k = 1; k < 4; ++k)
    if (c.vertex[k] >= 0) d += c.weight[k] * x[at(c.vertex[k])];
  return d;
}

LimitedSpring pull_of(const Cord& c, double length) {
  return limited_spring(length - c.length, c.stiffness, c.limit);
}

}  // namespace

Cords::Cords(std::vector<Cord> cords) : cords_(std::move(cords)) {}

std::vector<std::array<int, 4>> Cords::stencils() const {
  std::vector<std::array<int, 4>> out;
  for (const Cord& c : cords_) out.push_back(c.vertex);
  return out;
}

double Cords::value(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Cord& c : cords_)
    if (c.stiffness > 0) sum += pull_of(c, gap(c, x).norm()).energy;
  return sum;
}

void Cords::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  for (const Cord& c : cords_) {
    const Vec3 d = gap(c, x);
    const double length = d.norm();
    if (c.stiffness == 0 || length < k_no_length) continue;
    const double force = pull_of(c, length).force;
    for (std::size_t k = 0; k < 4; ++k)
      if (c.vertex[k] >= 0) gradient[at(c.vertex[k])] += (c.weight[k] * force / length) * d;
  }
}

void Cords::add_hessian(std::span<const Vec3> x, BlockMatrix& hessian) const {
  positions_.bind(*hessian.pattern, cords_.size(),
                  [&](std::size_t cord, std::size_t corner) { return cords_[cord].vertex[corner]; });
  for (std::size_t i = 0; i < cords_.size(); ++i) {
    const Cord& c = cords_[i];
    const Vec3 d = gap(c, x);
    const double length = d.norm();
    if (c.stiffness == 0 || length < c.length) continue;
    Mat3 stiffness = Mat3::Identity() * c.stiffness;
    if (length >= k_no_length) {
      const LimitedSpring pull = pull_of(c, length);
      const Mat3 along = d * d.transpose() / (length * length);
      stiffness = pull.secant * along + (pull.force / length) * (Mat3::Identity() - along);
    }
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a; b < 4; ++b) {
        if (c.vertex[a] < 0 || c.vertex[b] < 0) continue;
        const double times = a != b && c.vertex[a] == c.vertex[b] ? 2 : 1;
        hessian.blocks[at(positions_.place(i, a, b, c.vertex[a], c.vertex[b]))] +=
            (times * c.weight[a] * c.weight[b] * stiffness).cast<float>();
      }
  }
}

}  // namespace ft::inline solvers
