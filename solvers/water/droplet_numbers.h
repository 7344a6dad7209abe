// Droplets as numbers of a state: id, place, velocity, volume, one after another.
#pragma once

#include "solvers/water/water_body.h"

namespace ft::inline solvers {

inline constexpr std::size_t k_droplet_numbers = 8;

std::vector<Droplet> read_droplets(std::span<const double> numbers);
std::vector<double> write_droplets(std::span<const Droplet> droplets);

}  // namespace ft::inline solvers
