#include "solvers/water/pond/wave_step.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "baker/core/parallel.h"
#include "solvers/water/pond/decay.h"

// Functions that return vectors stay in this file: their calling convention is nobody else's concern.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace ft::inline solvers {
namespace {

/// Four at a time, in an order of our own: sums are the same on every machine.
typedef double Four __attribute__((vector_size(32)));
typedef float FourFloats __attribute__((vector_size(16)));
constexpr std::size_t k_sums = 7;
constexpr std::size_t k_rows = 16;  ///< in a block

inline Four load(const double* from) {
  Four out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
inline Four load(const float* from) {
  FourFloats out;
  std::memcpy(&out, from, sizeof out);
  return __builtin_convertvector(out, Four);
}
inline void store(double* to, const Four& value) {
  std::memcpy(to, &value, sizeof value);
}
inline double sum(const Four& f) {
  return (f[0] + f[1]) + (f[2] + f[3]);
}

/// Kernels of a row, with the attenuation of what lies under water.
struct KernelRow {
  const float *phi, *chi;
  const double* fade;  ///< null: 1
  std::size_t reach;   ///< waves of the row from here on are attenuated to nothing
};

/// Of a row whose waves have at least k_row across it [1/m], those that are felt under so much water; a multiple of
/// four.
std::size_t felt(const PondModes& modes, double k_row, double top_depth, std::size_t stride) {
  const double most = k_nothing / top_depth;
  if (!(most > k_row)) return 0;
  const double along = std::sqrt(most * most - k_row * k_row) * modes.length_x / std::numbers::pi;
  if (along >= static_cast<double>(stride)) return stride;
  return std::min(stride, (static_cast<std::size_t>(along) / 4 + 1) * 4);
}

void add_source(const WaveSource& s, const WaveStepScratch::Source& w, const KernelRow& row, const double* k,
                std::size_t j, double scale_z, double* eta) {
  const double cz = scale_z * w.here.cos_z[j], sz = scale_z * w.here.sin_z[j];
  const double a = s.volume * cz, b = s.way_x * cz, c = s.way_z * sz, d = -s.sinking * cz;
  const double *dc = w.deposit_cos.data(), *ds = w.deposit_sin.data();
  if (row.fade == nullptr) {
    for (std::size_t i = 0; i < row.reach; i += 4) {
      const Four cx = load(dc + i), sx = load(ds + i);
      store(eta + i, load(eta + i) + load(row.phi + i) * (a * cx) + load(row.chi + i) * (b * sx + c * cx));
    }
    return;
  }
  for (std::size_t i = 0; i < row.reach; i += 4) {
    const Four cx = load(dc + i), sx = load(ds + i), fade = load(row.fade + i);
    store(eta + i, load(eta + i) + fade * (load(row.phi + i) * ((a + d * load(k + i)) * cx) +
                                           load(row.chi + i) * (b * sx + c * cx)));
  }
}

/// Sums along a row, still without the phases along z.
void read_row(const WaveStepScratch::Source& w, const KernelRow& row, const double* k, const double* rise,
              const double* eta, const double* potential, double* sums) {
  Four level{}, slope{}, side{}, pull{}, run{}, run_side{}, climb{};
  const double *pc = w.next.cos_x.data(), *ps = w.next.sin_x.data();
  for (std::size_t i = 0; i < row.reach; i += 4) {
    const Four cx = load(pc + i), e = load(eta + i), p = load(potential + i);
    Four phi = load(row.phi + i), chi = load(row.chi + i);
    if (row.fade != nullptr) {
      const Four fade = load(row.fade + i);
      phi *= fade, chi *= fade;
      pull += phi * cx * e * load(k + i);
    }
    const Four phi_c = phi * cx, chi_c = chi * cx, chi_s = chi * load(ps + i);
    level += phi_c * e;
    slope += chi_s * e;
    side += chi_c * e;
    run += chi_s * p;
    run_side += chi_c * p;
    climb += phi_c * p * load(rise + i);
  }
  sums[0] = sum(level), sums[1] = sum(slope), sums[2] = sum(side), sums[3] = sum(pull);
  sums[4] = sum(run), sums[5] = sum(run_side), sums[6] = sum(climb);
}

void advance_row(const PondModes& modes, std::size_t at, double kick, double drift, std::size_t stride, double* eta,
                 double* potential) {
  const double* rise = modes.rise.data() + at;
  if (kick != 0) {
    if (modes.stiffness.empty())
      for (std::size_t i = 0; i < stride; ++i) potential[i] -= kick * modes.gravity * eta[i];
    else
      for (std::size_t i = 0; i < stride; ++i) potential[i] -= kick * modes.stiffness[at + i] * eta[i];
  }
  if (drift != 0)
    for (std::size_t i = 0; i < stride; ++i) eta[i] += drift * rise[i] * potential[i];
}

void fade_row(double top_depth, const double* k, std::size_t stride, double* fade) {
  for (std::size_t i = 0; i < stride; ++i) fade[i] = decay(k[i] * top_depth);
}

bool pushes(const WaveSource& s) {
  return s.volume != 0 || s.way_x != 0 || s.way_z != 0 || s.sinking != 0;
}

}  // namespace

void step_waves(const PondModes& modes, std::span<const WaveSource> sources, double kick, double drift,
                std::span<double> eta, std::span<double> potential, std::span<WaveProbe> probes,
                WaveStepScratch& scratch) {
  const auto stride = static_cast<std::size_t>(modes.stride), rows = static_cast<std::size_t>(modes.nz);
  const std::size_t count = sources.size();
  scratch.sources.resize(count);
  scratch.row_sums.assign(rows * count * k_sums, 0);
  parallel_for(count, 1, [&](std::size_t b, std::size_t) {
    WaveStepScratch::Source& w = scratch.sources[b];
    w.here.set(modes, sources[b].x, sources[b].z);
    w.next.set(modes, sources[b].next_x, sources[b].next_z);
    w.deposit_cos.resize(stride), w.deposit_sin.resize(stride);
    for (std::size_t i = 0; i < stride; ++i) {
      const double scale = (i == 0 ? 1 : 2) / modes.length_x;
      w.deposit_cos[i] = scale * w.here.cos_x[i];
      w.deposit_sin[i] = scale * w.here.sin_x[i];
    }
  });
  parallel_for(rows, k_rows, [&](std::size_t begin, std::size_t end) {
    std::vector<double> fade(stride);
    for (std::size_t j = begin; j < end; ++j) {
      const std::size_t at = j * stride;
      const double *k = modes.k.data() + at, *rise = modes.rise.data() + at;
      const auto kernel = [&](const WaveSource& s, double top_depth) {
        const std::size_t reach = top_depth > 0 ? felt(modes, modes.kz[j], top_depth, stride) : stride;
        if (top_depth > 0) fade_row(top_depth, k, reach, fade.data());
        return KernelRow{s.kernel->phi.data() + at, s.kernel->chi.data() + at, top_depth > 0 ? fade.data() : nullptr,
                         reach};
      };
      for (std::size_t b = 0; b < count; ++b)
        if (pushes(sources[b]))
          add_source(sources[b], scratch.sources[b], kernel(sources[b], sources[b].top_depth), k, j,
                     (j == 0 ? 1 : 2) / modes.length_z, eta.data() + at);
      advance_row(modes, at, kick, drift, stride, eta.data() + at, potential.data() + at);
      for (std::size_t b = 0; b < count; ++b)
        read_row(scratch.sources[b], kernel(sources[b], sources[b].next_top_depth), k, rise, eta.data() + at,
                 potential.data() + at, scratch.row_sums.data() + (j * count + b) * k_sums);
    }
  });
  for (std::size_t b = 0; b < count; ++b) {
    WaveProbe p;
    const Phases& next = scratch.sources[b].next;
    for (std::size_t j = 0; j < rows; ++j) {
      const double* s = scratch.row_sums.data() + (j * count + b) * k_sums;
      p.level += next.cos_z[j] * s[0];
      p.slope_x += next.cos_z[j] * s[1], p.slope_z += next.sin_z[j] * s[2];
      p.pull += next.cos_z[j] * s[3];
      p.velocity_x += next.cos_z[j] * s[4], p.velocity_z += next.sin_z[j] * s[5];
      p.velocity_y += next.cos_z[j] * s[6];
    }
    probes[b] = p;
  }
}

}  // namespace ft::inline solvers
