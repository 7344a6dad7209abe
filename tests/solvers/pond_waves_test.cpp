// The waves of the pond against closed forms: transform, dispersion, walls, kernels.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "baker/core/random.h"
#include "baker/core/types.h"
#include "solvers/water/pond/wave_step.h"

namespace ft {
namespace {

std::vector<double> random_grid(const PondModes& m) {
  std::vector<double> out(m.size(), 0.0);
  for (std::size_t j = 0; j < at(m.nz); ++j)
    for (std::size_t i = 0; i < at(m.nx); ++i) out[j * at(m.stride) + i] = random_uniform({7, 0, j, i}) - 0.5;
  return out;
}

TEST(PondWaves, A_grid_comes_back_from_its_waves_whatever_its_even_size) {
  for (const auto& [nx, nz] : {std::pair{64, 32}, {30, 22}, {96, 14}}) {
    const PondModes m(nx, nz, 3, 2, 1, 9.81, 0);
    const std::vector<double> before = random_grid(m);
    std::vector<double> grid = before;
    m.transform.to_waves(grid);
    double sum = 0;
    for (const double x : before) sum += x;
    EXPECT_NEAR(grid[0], sum / (nx * nz), 1e-15) << "the first wave is the mean";
    m.transform.to_values(grid);
    for (std::size_t i = 0; i < grid.size(); ++i) ASSERT_NEAR(grid[i], before[i], 1e-14);
  }
}

TEST(PondWaves, A_wave_is_the_cosine_it_says) {
  const PondModes m(30, 22, 3, 2, 1, 9.81, 0);
  std::vector<double> grid(m.size(), 0.0);
  grid[at(m.stride) * 5 + 7] = 1;
  m.transform.to_values(grid);
  for (int j = 0; j < m.nz; ++j)
    for (int i = 0; i < m.nx; ++i)
      ASSERT_NEAR(grid[at(j * m.stride + i)],
                  std::cos(m.kx[7] * (i + 0.5) * m.cell_x()) * std::cos(m.kz[5] * (j + 0.5) * m.cell_z()), 1e-13);
}

/// Period of the standing wave of that column, from its zero crossings [s].
double period(const PondModes& m, std::size_t wave, double dt, int crossings) {
  std::vector<double> eta(m.size(), 0.0), potential(m.size(), 0.0);
  eta[wave] = 0.01;
  WaveStepScratch scratch;
  double before = eta[wave], first = -1, last = -1;
  int seen = 0;
  step_waves(m, {}, 0.5 * dt, 0, eta, potential, {}, scratch);
  for (int n = 0; seen <= crossings; ++n) {
    step_waves(m, {}, 0, dt, eta, potential, {}, scratch);
    step_waves(m, {}, dt, 0, eta, potential, {}, scratch);
    const double now = eta[wave];
    if (before > 0 && now <= 0) {
      last = dt * (n + before / (before - now));
      if (seen++ == 0) first = last;
    }
    before = now;
  }
  return (last - first) / crossings;
}

// The bar is 0.5 %; what the step of 1/240 s does is (w dt)^2 / 24 = 5e-5.
TEST(PondWaves, Waves_of_one_metre_on_five_metres_run_at_their_speed) {
  const PondModes m(128, 8, 16, 1, 5, 9.81, 0);
  const double k = m.kx[32];
  ASSERT_NEAR(2 * std::numbers::pi / k, 1, 1e-12);
  const double speed = 2 * std::numbers::pi / period(m, 32, 1.0 / 240, 5) / k;
  RecordProperty("speed", std::to_string(speed));
  EXPECT_NEAR(speed, 1.2495, 1e-3 * 1.2495);
}

TEST(PondWaves, A_basin_swings_at_its_period) {
  const PondModes m(64, 8, 2, 1, 0.5, 9.81, 0);
  const double k = std::numbers::pi / 2;
  EXPECT_NEAR(period(m, 1, 1.0 / 240, 3), 2 * std::numbers::pi / std::sqrt(9.81 * k * std::tanh(k * 0.5)), 1e-3);
}

TEST(PondWaves, Surface_tension_hastens_ripples) {
  const PondModes m(128, 8, 0.64, 0.04, 0.5, 9.81, 0.072e-3);
  const double k = m.kx[64];  // 2 cm
  const double exact = 2 * std::numbers::pi / std::sqrt(k * std::tanh(k * 0.5) * (9.81 + 0.072e-3 * k * k));
  EXPECT_NEAR(period(m, 64, 1.0 / 4000, 5), exact, 1e-3 * exact);
}

TEST(PondWaves, Waves_keep_their_energy_and_volume) {
  const PondModes m(64, 32, 8, 4, 2, 9.81, 0);
  std::vector<double> eta = random_grid(m), potential(m.size(), 0.0);
  m.transform.to_waves(eta);
  for (double& x : eta) x *= 0.01;
  const double volume = eta[0], before = wave_energy(m, eta, potential);
  WaveStepScratch scratch;
  const double dt = 1.0 / 240;
  step_waves(m, {}, 0.5 * dt, 0, eta, potential, {}, scratch);
  for (int n = 0; n < 960; ++n)
    step_waves(m, {}, n < 959 ? dt : 0.5 * dt, n < 959 ? dt : 0, eta, potential, {}, scratch);
  EXPECT_EQ(eta[0], volume);
  // The step's own energy differs from the true one by (w dt)^2 / 8, at most, of the shortest waves: 1 %.
  EXPECT_NEAR(wave_energy(m, eta, potential), before, 0.01 * before);
}

TEST(PondWaves, Kernels_start_at_one_with_the_slope_of_long_waves) {
  EXPECT_EQ(heave_kernel(0), 1);
  EXPECT_EQ(surge_kernel(0), 1);
  EXPECT_NEAR((1 - heave_kernel(1e-4)) / 1e-4, 1, 1e-3);
  double before = 1;
  for (double q = 0.01; q < 30; q += 0.01) {
    ASSERT_LT(heave_kernel(q), before);
    before = heave_kernel(q);
  }
}

/// Level of a source at itself and at another by sums over waves, against the integral in open water.
TEST(PondWaves, What_a_source_pushes_up_is_read_where_it_is) {
  const PondModes m(128, 96, 12, 9, 5, 9.81, 0);
  const KernelTable kernel(m, 0.3);
  std::vector<double> eta(m.size(), 0.0), potential(m.size(), 0.0);
  WaveSource s{&kernel, 6.1, 4.4, 0, 0.05, 0, 0, 0, 6.1, 4.4, 0};
  WaveProbe probe;
  WaveStepScratch scratch;
  step_waves(m, {&s, 1}, 0, 0, eta, potential, {&probe, 1}, scratch);
  EXPECT_NEAR(eta[0] * m.area(), 0.05, 1e-16);
  EXPECT_NEAR(probe.level, 0.05 * kernel.self_level, 0.02 * probe.level);
  EXPECT_NEAR(probe.slope_x, 0, 1e-3 * probe.level);
  // A step aside is the derivative.
  std::vector<double> way(m.size(), 0.0);
  WaveProbe none;
  s.volume = 0, s.way_x = 1e-3;
  step_waves(m, {&s, 1}, 0, 0, way, potential, {&none, 1}, scratch);
  WaveSource plus{&kernel, 6.1, 4.4, 0, 0, 0, 0, 0, 6.1 + 1e-4, 4.4, 0}, minus = plus;
  minus.next_x = 6.1 - 1e-4;
  WaveProbe here, there;
  step_waves(m, {&plus, 1}, 0, 0, way, potential, {&here, 1}, scratch);
  step_waves(m, {&minus, 1}, 0, 0, way, potential, {&there, 1}, scratch);
  EXPECT_GT(std::abs(here.level - there.level), 0);
  EXPECT_NEAR(here.level + there.level, 0, 2e-3 * std::abs(here.level - there.level) + 1e-7);
}

// A source s below the surface has exp(-k s): read as the same number by brute force.
TEST(PondWaves, What_lies_deep_is_felt_less) {
  const PondModes m(32, 30, 6, 5, 5, 9.81, 0);
  const KernelTable kernel(m, 0.4);
  std::vector<double> eta = random_grid(m), potential(m.size(), 0.0);
  WaveSource s{&kernel, 0, 0, 0, 0, 0, 0, 0, 2.2, 1.7, 0.35};
  WaveProbe probe;
  WaveStepScratch scratch;
  step_waves(m, {&s, 1}, 0, 0, eta, potential, {&probe, 1}, scratch);
  double level = 0, pull = 0;
  for (std::size_t j = 0; j < at(m.nz); ++j)
    for (std::size_t i = 0; i < at(m.nx); ++i) {
      const std::size_t n = j * at(m.stride) + i;
      const double w = static_cast<double>(kernel.phi[n]) * std::exp(-0.35 * m.k[n]) * std::cos(m.kx[i] * 2.2) *
                       std::cos(m.kz[j] * 1.7) * eta[n];
      level += w, pull += m.k[n] * w;
    }
  EXPECT_NEAR(probe.level, level, 1e-12);
  EXPECT_NEAR(probe.pull, pull, 1e-11);
}

}  // namespace
}  // namespace ft
