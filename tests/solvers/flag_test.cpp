// A flag of 1.5 x 1 m and 0.15 kg/m2 at its mast: limp ones flap in a wind, stiff ones do not, and in still air all
// hang.
#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "solvers/validation/scene_parts.h"
#include "solvers/wind/registry.h"

namespace ft {
namespace {

constexpr double k_length = 1.5, k_height = 1;
constexpr int k_columns = 36, k_rows = 24;

struct Flag {
  double swing = 0;       ///< of the free edge's middle across the wind, by the length [1]
  double wavelength = 0;  ///< by the length, positive from the mast outwards [1]
};

ClothRun run_of(double bending, double speed) {
  const Mesh mesh = rectangle_mesh(k_columns, k_rows,
                                   [&](double s, double t) { return Vec3(k_length * s, -k_height * t, 0.02 * s * s); });
  Fabric fabric = plain_fabric(0.15, 2000, bending, 0.2);
  fabric.drag_normal = 1.2;
  fabric.drag_tangential = 0.03;
  fabric.lift = 0.8;
  fabric.added_mass = std::numbers::pi / 4 * k_height;
  ClothSetup setup = accurate_setup(mesh, fabric, 24, 8);
  setup.newton_iterations = 4;
  setup.linear_tolerance = 1e-2;
  setup.air_density = 1.225;
  setup.garments[0].self_collision = false;
  setup.wind = steady_wind(Vec3(speed, 0, 0));
  std::vector<int> mast;
  for (int j = 0; j <= k_rows; ++j) mast.push_back(j * (k_columns + 1));
  pin_stiffly(setup, mast, 1e8);
  return ClothRun(std::move(setup));
}

/// Of the middle row, once the flag has got going.
Flag flag_in(double bending, double speed, int frames) {
  ClothRun run = run_of(bending, speed);
  run.advance(frames / 3);
  std::vector<std::vector<double>> rows;  // z of the middle row, by frame
  for (int k = frames / 3; k < frames; ++k) {
    run.advance();
    const std::vector<Vec3> x = run.positions();
    auto& row = rows.emplace_back();
    for (int i = 0; i <= k_columns; ++i) row.push_back(x[at(k_rows / 2 * (k_columns + 1) + i)].z());
  }
  const auto component = [&](int i, double frequency) {  // of a place along the row
    double mean = 0;
    for (const auto& row : rows) mean += row[at(i)] / static_cast<double>(rows.size());
    std::complex<double> sum = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
      sum += (rows[k][at(i)] - mean) * std::polar(1.0, 2 * std::numbers::pi * frequency * static_cast<double>(k) / 24);
    return sum;
  };
  double strongest = 0, frequency = 0;
  for (double f = 0.3; f < 8; f += 0.05)
    if (const double now = std::abs(component(k_columns, f)); now > strongest) strongest = now, frequency = f;
  // The phase that the wave gains over the outer two thirds.
  double gained = 0;
  for (int i = k_columns / 3; i < k_columns; ++i)
    gained += std::arg(component(i + 1, frequency) / component(i, frequency));
  Flag out;
  out.wavelength = 2 * std::numbers::pi / gained * (2.0 / 3);
  double lowest = rows[0].back(), highest = lowest;
  for (const auto& row : rows) lowest = std::min(lowest, row.back()), highest = std::max(highest, row.back());
  out.swing = (highest - lowest) / k_length;
  return out;
}

TEST(Flag, A_limp_one_flaps_in_a_wave_from_the_mast_outwards_slow) {
  const Flag flag = flag_in(2e-6, 8, 240);
  printf("swing %.2f L, wave %.2f L\n", flag.swing, flag.wavelength);
  EXPECT_GT(flag.swing, 0.3);
  EXPECT_NEAR(flag.wavelength, 1.87, 0.25 * 1.87);
}

TEST(Flag, A_stiff_one_does_not_flap_slow) {
  EXPECT_LT(flag_in(0.5, 8, 96).swing, 0.02);
}

TEST(Flag, In_still_air_a_limp_one_hangs_and_comes_to_rest_slow) {
  ClothRun run = run_of(2e-6, 0);
  run.advance(24 * 8);
  double fastest = 0, farthest = 0;
  for (const Vec3& v : run.velocities()) fastest = std::max(fastest, v.norm());
  for (const Vec3& p : run.positions()) farthest = std::max(farthest, p.x());
  printf("after 8 s: %.3f m/s at most, %.2f m from the mast\n", fastest, farthest);
  EXPECT_LT(fastest, 0.1);
  EXPECT_LT(farthest, 0.8 * k_length);
}

}  // namespace
}  // namespace ft
