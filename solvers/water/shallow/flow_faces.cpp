// What is at single faces and over edges, and how fast water is. See flow.h.
#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "solvers/water/shallow/flow.h"
#include "solvers/water/shallow/flow_limits.h"

namespace ft::inline solvers {

void find_face_beds(Flow& f) {
  for (const bool along_x : {true, false}) {
    const std::size_t back = along_x ? 1 : f.row;
    std::vector<double>& out = along_x ? f.bed_x : f.bed_z;
    for (int k = 0; k <= f.nz; ++k)
      for (int i = 0; i <= f.nx; ++i) {
        const std::size_t c = f.of(i, k);
        const auto slope = [&](std::size_t n) {
          const std::size_t far = std::min(n + back, f.size() - 1);
          return 0.5 * van_leer(f.bed[n] - f.bed[n - back], f.bed[far] - f.bed[n]);
        };
        out[c] = std::max(f.bed[c - back] + slope(c - back), f.bed[c] - slope(c));
      }
  }
}

double face_depth(const Flow& f, std::size_t c, bool along_x, double v) {
  const std::size_t back = along_x ? 1 : f.row, from = v > 0 ? c - back : c;
  const double level = f.bed[from] + f.h[from], below = f.bed[from - back] + f.h[from - back],
               above = f.bed[from + back] + f.h[from + back];
  const bool wet = std::min(std::min(f.h[from], f.h[from - back]), f.h[from + back]) > k_dry;
  const double slope = wet ? 0.5 * van_leer(level - below, above - level) : 0.0;
  const double depth = level + (v > 0 ? slope : -slope) - (along_x ? f.bed_x : f.bed_z)[c];
  return std::min(std::max(0.0, depth), 2 * f.h[from]);
}

double passed_flux(const Flow& f, std::size_t c, bool along_x, double dt) {
  const double q = (along_x ? f.qx1 : f.qz1)[c];
  const std::size_t from = q > 0 ? c - (along_x ? 1 : f.row) : c;
  const double leaves = std::max(0.0, f.qx1[from + 1]) + std::max(0.0, -f.qx1[from]) +
                        std::max(0.0, f.qz1[from + f.row]) + std::max(0.0, -f.qz1[from]);
  return q * draining(f.h[from], dt / f.cell * leaves);
}

double step_outflow(const Flow& f, double dt) {
  double out = 0;
  // What comes in is not cut.
  const auto add = [&](std::size_t c, bool along_x, double outwards) {
    const double q = (along_x ? f.qx1 : f.qz1)[c];
    out += outwards * (q * outwards > 0 ? passed_flux(f, c, along_x, dt) : q);
  };
  for (int k = 0; k < f.nz; ++k) {
    if (f.sides[0] == FlowSide::k_open) add(f.of(0, k), true, -1);
    if (f.sides[1] == FlowSide::k_open) add(f.of(f.nx, k), true, 1);
  }
  for (int i = 0; i < f.nx; ++i) {
    if (f.sides[2] == FlowSide::k_open) add(f.of(i, 0), false, -1);
    if (f.sides[3] == FlowSide::k_open) add(f.of(i, f.nz), false, 1);
  }
  return out * f.cell * dt;
}

double highest_water(const Flow& f) {
  double top = -1e300;
  for (int k = 0; k < f.nz; ++k)
    for (int i = 0; i < f.nx; ++i) {
      const std::size_t c = f.of(i, k);
      if (f.h[c] > k_dry) top = std::max(top, f.bed[c] + f.h[c]);
    }
  return top;
}

void flow_speeds(const Flow& f, const FlowLaws& laws, std::vector<double>& speeds) {
  const int across = speed_tiles(f.nx);
  speeds.assign(at(across) * at(speed_tiles(f.nz)), 0.0);
  parallel_for(at(speed_tiles(f.nz)), 4, [&](std::size_t begin, std::size_t end) {
    for (int k = static_cast<int>(begin) * k_speed_tile; k < std::min(f.nz, static_cast<int>(end) * k_speed_tile);
         ++k) {
      const std::size_t c = f.of(0, k);
      for (int i = 0; i < f.nx; ++i) {
        const double u = f.u[c + at(i)], w = f.w[c + at(i)];
        double& most = speeds[at(i / k_speed_tile) + at(across) * at(k / k_speed_tile)];
        most =
            std::max(most, std::sqrt(std::max(u * u, w * w)) + k_wave_share * std::sqrt(laws.gravity * f.h[c + at(i)]));
      }
    }
  });
}

}  // namespace ft::inline solvers
