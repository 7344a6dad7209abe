#include "solvers/water/pond/pond_modes.h"

#include <cmath>
#include <numbers>

#include "baker/core/parallel.h"

namespace ft::inline solvers {

PondModes::PondModes(int nx_, int nz_, double length_x_, double length_z_, double depth_, double gravity_,
                     double tension)
    : nx(nx_),
      nz(nz_),
      stride((nx_ + 3) / 4 * 4),
      length_x(length_x_),
      length_z(length_z_),
      depth(depth_),
      gravity(gravity_),
      kx(static_cast<std::size_t>(stride)),
      kz(static_cast<std::size_t>(nz)),
      k(size()),
      rise(size()),
      transform(nx_, nz_, stride) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(nx); ++i)
    kx[i] = std::numbers::pi * static_cast<double>(i) / length_x;
  for (std::size_t j = 0; j < kz.size(); ++j) kz[j] = std::numbers::pi * static_cast<double>(j) / length_z;
  if (tension > 0) stiffness.assign(size(), gravity);
  for (std::size_t j = 0; j < kz.size(); ++j)
    for (std::size_t i = 0; i < static_cast<std::size_t>(nx); ++i) {
      const std::size_t m = j * kx.size() + i;
      k[m] = std::hypot(kx[i], kz[j]);
      rise[m] = k[m] * std::tanh(k[m] * depth);
      if (tension > 0) stiffness[m] = gravity + tension * k[m] * k[m];
    }
}

double PondModes::fastest() const {
  double most = 0;
  for (std::size_t m = 0; m < rise.size(); ++m)
    most = std::max(most, rise[m] * (stiffness.empty() ? gravity : stiffness[m]));
  return std::sqrt(most);
}

double wave_energy(const PondModes& modes, std::span<const double> eta, std::span<const double> potential) {
  const auto stride = static_cast<std::size_t>(modes.stride);
  const double twice = parallel_sum(static_cast<std::size_t>(modes.nz), 16, 0.0, [&](std::size_t b, std::size_t e) {
    double sum = 0;
    for (std::size_t j = b; j < e; ++j) {
      double row = 0;
      for (std::size_t i = 0; i < stride; ++i) {
        const std::size_t m = j * stride + i;
        const double g = modes.stiffness.empty() ? modes.gravity : modes.stiffness[m];
        const double wave = g * eta[m] * eta[m] + modes.rise[m] * potential[m] * potential[m];
        row += i == 0 ? wave : 0.5 * wave;
      }
      sum += j == 0 ? row : 0.5 * row;
    }
    return sum;
  });
  return 0.5 * modes.area() * twice;
}

void Phases::set(const PondModes& modes, double x, double z) {
  const auto fill = [](std::span<const double> k, double place, std::vector<double>& c, std::vector<double>& s) {
    c.resize(k.size()), s.resize(k.size());
    for (std::size_t i = 0; i < k.size(); ++i) {
      c[i] = std::cos(k[i] * place);
      s[i] = -k[i] * std::sin(k[i] * place);
    }
  };
  fill(modes.kx, x, cos_x, sin_x);
  fill(modes.kz, z, cos_z, sin_z);
}

}  // namespace ft::inline solvers
