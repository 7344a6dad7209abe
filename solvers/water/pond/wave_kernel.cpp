#include "solvers/water/pond/wave_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace ft::inline solvers {
namespace {

struct HulmeRow {
  double q, added, damping;
};
/// Hulme, J. Fluid Mech. 121 (1982), table 1 (heave): normalised by 2/3 pi rho a^3 and that times the frequency. That
/// one follows from the other by the relation of Kramers and Kronig was checked to 0.2 %.
constexpr std::array<HulmeRow, 26> k_hulme = {{
    {0, 0.8310, 0},        {0.05, 0.8764, 0.1036}, {0.1, 0.8627, 0.1816}, {0.2, 0.7938, 0.2793}, {0.3, 0.7157, 0.3254},
    {0.4, 0.6452, 0.3410}, {0.5, 0.5861, 0.3391},  {0.6, 0.5381, 0.3271}, {0.7, 0.4999, 0.3098}, {0.8, 0.4698, 0.2899},
    {0.9, 0.4464, 0.2691}, {1, 0.4284, 0.2484},    {1.2, 0.4047, 0.2096}, {1.4, 0.3924, 0.1756}, {1.6, 0.3871, 0.1469},
    {1.8, 0.3864, 0.1229}, {2, 0.3884, 0.1031},    {2.5, 0.3988, 0.0674}, {3, 0.4111, 0.0452},   {4, 0.4322, 0.0219},
    {5, 0.4471, 0.0116},   {6, 0.4574, 0.0066},    {7, 0.4647, 0.0040},   {8, 0.4700, 0.0026},   {9, 0.4740, 0.0017},
    {10, 0.4771, 0.0012},
}};
constexpr double k_tail_power = -2.2;  ///< of phi beyond the table

double log_kernel(std::size_t row) {
  const HulmeRow& r = k_hulme[row];
  if (row == 0) return 0;
  const std::complex<double> c(-2.0 / 3 * r.q * (r.added - 0.5), 2.0 / 3 * r.q * r.damping);
  return std::log(std::sqrt(4 * r.damping / (3 * std::numbers::pi * r.q)) / std::abs(1.0 + c));
}

/// Slope of the parabola through a row and its neighbours.
double slope(std::size_t row) {
  const auto secant = [](std::size_t i) {
    return (log_kernel(i + 1) - log_kernel(i)) / (k_hulme[i + 1].q - k_hulme[i].q);
  };
  // A long wave acts at depth d.
  if (row == 0) return -1;
  if (row + 1 == k_hulme.size()) return secant(row - 1);
  const double a = k_hulme[row].q - k_hulme[row - 1].q, b = k_hulme[row + 1].q - k_hulme[row].q;
  return (b * secant(row - 1) + a * secant(row)) / (a + b);
}

}  // namespace

double heave_kernel(double q) {
  const double last = k_hulme.back().q;
  if (q >= last) return std::exp(log_kernel(k_hulme.size() - 1)) * std::pow(q / last, k_tail_power);
  std::size_t i = 0;
  while (i + 2 < k_hulme.size() && q > k_hulme[i + 1].q) ++i;
  const double h = k_hulme[i + 1].q - k_hulme[i].q, t = (q - k_hulme[i].q) / h;
  const double a = log_kernel(i), b = log_kernel(i + 1), u = 1 - t;
  return std::exp(u * u * (1 + 2 * t) * a + t * t * (3 - 2 * t) * b + h * t * u * (u * slope(i) - t * slope(i + 1)));
}

double surge_kernel(double q) {
  return std::exp(-0.745 * q);
}

KernelTable::KernelTable(const PondModes& modes, double depth_) : depth(depth_), phi(modes.size()), chi(modes.size()) {
  // As a function of |k|, from a fine table.
  constexpr int count = 4096;
  double most = 0;
  for (const double k : modes.k) most = std::max(most, k);
  std::vector<double> heave(count + 2), surge(count + 2);
  const double step = most / count;
  const double grid = std::numbers::pi / std::max(modes.cell_x(), modes.cell_z());
  for (std::size_t i = 0; i < heave.size(); ++i) {
    const double k = step * static_cast<double>(i);
    const double cut = std::exp(-4 * std::pow(k / grid, 8));
    heave[i] = cut * heave_kernel(k * depth);
    surge[i] = cut * surge_kernel(k * depth);
    if (i <= count) self_level += heave[i] * heave[i] * k * step / (2 * std::numbers::pi);
  }
  for (std::size_t m = 0; m < modes.size(); ++m) {
    if (modes.k[m] == 0 && m != 0) continue;  // padding
    const double place = modes.k[m] / step;
    const auto i = static_cast<std::size_t>(place);
    const double t = place - static_cast<double>(i);
    phi[m] = static_cast<float>((1 - t) * heave[i] + t * heave[i + 1]);
    chi[m] = static_cast<float>((1 - t) * surge[i] + t * surge[i + 1]);
  }
}

}  // namespace ft::inline solvers
