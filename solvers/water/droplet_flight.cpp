#include "solvers/water/droplet_flight.h"

#include <cmath>
#include <numbers>

#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 256;

}  // namespace

void fly(std::vector<Droplet>& droplets, const DropletAir& air, double gravity, double density, double dt,
         DropletBodies& bodies) {
  std::vector<Vec3> starts(droplets.size());
  parallel_for(droplets.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      Droplet& d = droplets[n];
      starts[n] = d.place;
      const double size = std::cbrt(6 / std::numbers::pi * d.volume);
      // Drag of a ball: 3/4 (air / water) Cd |v| / size; the fall between is exact without it.
      const double rate = 0.75 * air.density / density * air.drag / size * d.velocity.norm();
      const Vec3 next = (d.velocity - dt * Vec3(0, gravity, 0)) / (1 + dt * rate);
      d.place += 0.5 * dt * (d.velocity + next);
      d.velocity = next;
    }
  });
  bodies.stop(droplets, starts, dt);
}

}  // namespace ft::inline solvers
