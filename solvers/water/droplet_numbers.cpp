#include "solvers/water/droplet_numbers.h"

namespace ft::inline solvers {

std::vector<Droplet> read_droplets(std::span<const double> numbers) {
  std::vector<Droplet> out;
  for (std::size_t n = 0; n + k_droplet_numbers <= numbers.size(); n += k_droplet_numbers)
    out.push_back({static_cast<std::uint64_t>(numbers[n]), Vec3(numbers[n + 1], numbers[n + 2], numbers[n + 3]),
                   Vec3(numbers[n + 4], numbers[n + 5], numbers[n + 6]), numbers[n + 7]});
  return out;
}

std::vector<double> write_droplets(std::span<const Droplet> droplets) {
  std::vector<double> out;
  out.reserve(droplets.size() * k_droplet_numbers);
  for (const Droplet& d : droplets)
    out.insert(out.end(), {static_cast<double>(d.id), d.place.x(), d.place.y(), d.place.z(), d.velocity.x(),
                           d.velocity.y(), d.velocity.z(), d.volume});
  return out;
}

}  // namespace ft::inline solvers
