#include "solvers/hair/hair_crowd.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "baker/core/mesh.h"
#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr double k_most_cells = 1 << 20;  ///< of the grid: some 40 MB
constexpr double k_most_denser = 2;       ///< what is denser still pushes no harder: steps are explicit [1]

/// Weights of the eight cells around a spot: bit k of c says the upper one along axis k.
double weight_of(const Vec3& share, int c) {
  double out = 1;
  for (int k = 0; k < 3; ++k) out *= (c >> k & 1) != 0 ? share[k] : 1 - share[k];
  return out;
}

}  // namespace

HairCrowd::HairCrowd(const CrowdSettings& settings, std::span<const Vec3> groom, std::span<const double> mass)
    : settings_(settings), mass_(mass.begin(), mass.end()) {
  splat(groom, groom);  // it does not move: velocities are not asked for
  for (const Spot& spot : spots_) combed_.push_back(mass_around(spot));
  // A thin tip may lie among others: no place is too dense that is as dense as the groom is in the middle.
  std::vector<double> sorted = combed_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  for (double& m : combed_) m = std::max(m, *middle);
}

std::size_t HairCrowd::cell_of(const Spot& spot, int corner) const {
  return spot.first + (corner & 1) * stride_[0] + (corner >> 1 & 1) * stride_[1] + (corner >> 2 & 1) * stride_[2];
}

double HairCrowd::mass_around(const Spot& spot) const {
  double out = 0;
  for (int c = 0; c < 8; ++c) out += weight_of(spot.share, c) * cells_[cell_of(spot, c)].mass;
  return out;
}

/// One after the other: sums have one order.
void HairCrowd::splat(std::span<const Vec3> x, std::span<const Vec3> v) {
  const Box box = bounds(x);
  cell_ = settings_.cell;
  std::array<double, 3> count{};
  Vec3 low;
  for (;; cell_ *= 2) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::floor(box.lo[k] / cell_) - 1;
      count[at(k)] = std::floor(box.hi[k] / cell_) - low[k] + 3;
    }
    if (count[0] * count[1] * count[2] <= k_most_cells) break;
  }
  stride_ = {1, static_cast<std::size_t>(count[0]), static_cast<std::size_t>(count[0] * count[1])};
  cells_.assign(static_cast<std::size_t>(count[0] * count[1] * count[2]), Cell());
  spots_.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    Spot& spot = spots_[i];
    spot.first = 0;
    for (int k = 0; k < 3; ++k) {
      const double place = x[i][k] / cell_ - low[k], whole = std::floor(place);
      spot.first += static_cast<std::size_t>(whole) * stride_[at(k)];
      spot.share[k] = place - whole;
    }
    for (int c = 0; c < 8; ++c) {
      Cell& cell = cells_[cell_of(spot, c)];
      const double m = weight_of(spot.share, c) * mass_[i];
      cell.mass += m;
      cell.momentum += m * v[i];
    }
  }
}

void HairCrowd::feel(std::span<const Vec3> x, std::span<const Vec3> v, double h, std::vector<Vec3>& push,
                     std::vector<Vec3>& flow) {
  splat(x, v);
  // Cells that have become larger hold as much more.
  const double larger = std::pow(cell_ / settings_.cell, 3);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double denser = std::min(mass_around(spots_[i]) / (larger * combed_[i]) - 1 - settings_.spare, k_most_denser);
    if (!(denser > 0)) continue;
    for (int c = 0; c < 8; ++c)
      cells_[cell_of(spots_[i], c)].pressed += weight_of(spots_[i].share, c) * mass_[i] * settings_.pressure * denser;
  }
  push.resize(x.size()), flow.resize(x.size());
  const double most = 0.25 * cell_ / (h * h);
  parallel_for(x.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Spot& spot = spots_[i];
      Vec3 slope = Vec3::Zero(), momentum = Vec3::Zero();
      double mass = 0;
      for (int c = 0; c < 8; ++c) {
        const Cell& cell = cells_[cell_of(spot, c)];
        for (int a = 0; a < 3; ++a) {
          double w = (c >> a & 1) != 0 ? 1 : -1;
          for (int b = 0; b < 3; ++b)
            if (b != a) w *= (c >> b & 1) != 0 ? spot.share[b] : 1 - spot.share[b];
          slope[a] += cell.mass > 0 ? w / cell_ * cell.pressed / cell.mass : 0.0;
        }
        const double w = weight_of(spot.share, c);
        mass += w * cell.mass;
        momentum += w * cell.momentum;
      }
      const double size = slope.norm();
      push[i] = size > most ? Vec3(-most / size * slope) : Vec3(-slope);
      flow[i] = mass > 0 ? Vec3(momentum / mass) : v[i];
    }
  });
}

}  // namespace ft::inline solvers
