// See hair_solver.h: what the body feels of its hair.
#include "baker/core/parallel.h"
#include "baker/core/state_points.h"
#include "baker/core/volume.h"
#include "solvers/hair/hair_group.h"

namespace ft::inline solvers {
namespace {

struct Sum : Wrench {
  Sum operator+(const Sum& other) const {
    Sum out = *this;
    out += other;
    return out;
  }
};

}  // namespace

double HairSolver::mass() const {
  double sum = 0;
  for (std::size_t s = 0; s < setup_.strands.size(); ++s)
    for (std::size_t i = 1; i < at(n_); ++i) sum += rods_[s / k_lanes].mass[i][static_cast<int>(s % k_lanes)];
  return hairs_ * sum;
}

/// In the step that has just ended, by the balance of momentum, about the world's origin [N s].
Wrench HairSolver::impulse_on_scalp(const State& state, double h, const AirNow* air) const {
  const auto x = as_points(*state.find("x")), v = as_points(*state.find("v")), x0 = as_points(*state.find("x_before")),
             v0 = as_points(*state.find("v_before"));
  return parallel_sum(setup_.strands.size(), 16, Sum(), [&](std::size_t begin, std::size_t end) {
    Sum out;
    for (std::size_t s = begin; s < end; ++s)
      for (std::size_t i = 1; i < at(n_); ++i) {
        const std::size_t k = s * at(n_) + i;
        const double mass = hairs_ * rods_[s / k_lanes].mass[i][static_cast<int>(s % k_lanes)];
        const Vec3 blows = air ? air->velocity(x0[k]) : Vec3::Zero();
        const Vec3 drag = setup_.material.air_drag * (blows - v0[k]).norm() * (blows - v[k]);
        out.add(x[k], mass * (h * (setup_.gravity + drag) - (v[k] - v0[k])));
      }
    return out;
  });
}

/// impulses: of each step of a frame that ends at a time; none: the scalp jumped.
void HairSolver::add_force(std::span<const Wrench> impulses, double h, double time, FrameReport& report) const {
  InteractionForce& row = report.forces.emplace_back();
  row.system = setup_.name;
  if (impulses.empty()) return;
  for (const Wrench& impulse : impulses) {
    row.mean += 1 / (h * static_cast<double>(impulses.size())) * impulse;
    row.peak = std::max(row.peak, impulse.force.norm() / h);
  }
  row.contact_share = 1;
  std::vector<Vec3> scalp(at(setup_.scalp->surface().vertex_count()));
  setup_.scalp->sample(time, scalp);
  row.mean = row.mean.moved(volume_centre(scalp, setup_.scalp->surface().triangles));
}

}  // namespace ft::inline solvers
