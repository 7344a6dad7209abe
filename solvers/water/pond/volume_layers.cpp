#include "solvers/water/pond/volume_layers.h"

#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "solvers/water/pond/decay.h"

namespace ft::inline solvers {

VolumeLayers::VolumeLayers(const PondModes& modes, double unit) : modes_(&modes) {
  for (double d = unit; depths_.size() < 9; d *= 2.2) depths_.push_back(d);
  layers_.resize(depths_.size());
  used_.assign(depths_.size(), 0);
}

void VolumeLayers::add(double x, double z, double depth, double volume) {
  std::size_t layer = 0;
  while (layer + 2 < depths_.size() && depth > depths_[layer + 1]) ++layer;
  const double t = std::clamp((depth - depths_[layer]) / (depths_[layer + 1] - depths_[layer]), 0.0, 1.0);
  const auto cell = [](double place, double size, int count, int& first, double& share) {
    const double p = std::clamp(place / size - 0.5, 0.0, count - 1.0);
    first = std::min(static_cast<int>(p), count - 2);
    share = p - first;
  };
  int i = 0, j = 0;
  double u = 0, v = 0;
  cell(x, modes_->cell_x(), modes_->nx, i, u);
  cell(z, modes_->cell_z(), modes_->nz, j, v);
  for (const auto& [l, share] : {std::pair{layer, 1 - t}, {layer + 1, t}}) {
    if (share == 0) continue;
    if (!used_[l]) layers_[l].assign(modes_->size(), 0.0);
    used_[l] = 1;
    double* at = layers_[l].data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(modes_->stride) + i;
    const double height = share * volume / (modes_->cell_x() * modes_->cell_z());
    at[0] += (1 - u) * (1 - v) * height, at[1] += u * (1 - v) * height;
    at[modes_->stride] += (1 - u) * v * height, at[modes_->stride + 1] += u * v * height;
  }
}

bool VolumeLayers::empty() const {
  return std::none_of(used_.begin(), used_.end(), [](char c) { return c != 0; });
}

void VolumeLayers::pour(std::span<double> waves) {
  for (std::size_t l = 0; l < depths_.size(); ++l) {
    if (!used_[l]) continue;
    modes_->transform.to_waves(layers_[l]);
    parallel_for(waves.size(), 4096, [&](std::size_t b, std::size_t e) {
      for (std::size_t m = b; m < e; ++m) {
        const double x = modes_->k[m] * depths_[l];
        waves[m] += layers_[l][m] * (x < k_nothing ? decay(x) : 0.0);
      }
    });
    used_[l] = 0;
  }
}

}  // namespace ft::inline solvers
