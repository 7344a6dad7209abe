// What the caches have of a water's surface beside its height: velocities that carry it to where it is a moment later,
// and scalars of its vertices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solvers/water/paper/paper_core.h"
#include "solvers/water/paper/paper_setup.h"
#include "solvers/water/pond/pond_core.h"
#include "solvers/water/pond/pond_setup.h"
#include "solvers/water/shallow/shallow_core.h"
#include "solvers/water/shallow/shallow_setup.h"
#include "solvers/water/water_solver.h"
#include "tests/solvers/pond_scenes.h"
#include "tests/solvers/water_scenes.h"

namespace ft::test {
namespace {

constexpr double k_fps = 480;

WaterSolver in_a_scene(Result<std::unique_ptr<WaterCore>> core, std::size_t floats = 0, double fps = k_fps) {
  EXPECT_TRUE(core.ok()) << (core.ok() ? "" : core.error().text());
  WaterScene scene;
  scene.first_frame = 0, scene.fps = fps;
  scene.floats.resize(floats);
  return WaterSolver(std::move(scene), std::move(core).value());
}

struct Surface {
  std::vector<Vec3> x, v;
};
Surface surface_of(const WaterSolver& solver, const State& state) {
  Surface out{std::vector<Vec3>(solver.system_mesh(0).positions.size()), {}};
  out.v = out.x;
  solver.system_positions(state, 0, out.x);
  solver.surface_flow(state, 0, out.v);
  return out;
}

struct Missed {
  double whole = 0, along = 0;
};
/// How far the surface of the frame before last that is moved by its velocities is from that of the last, by how far it
/// has come there; root mean squares over the vertices that stay inside. along: without what it climbs along its slope.
Missed missed(WaterSolver& solver, State& state) {
  const WaterGrid grid = solver.core().grid();
  const Surface before = surface_of(solver, state);
  solver.advance_frame(state);
  const Surface now = surface_of(solver, state);
  solver.advance_frame(state);
  const Surface next = surface_of(solver, state);
  double whole = 0, along = 0, stayed = 0;
  for (std::size_t n = 0; n < now.x.size(); ++n) {
    const Vec3 rise(0, 0.5 * (next.x[n].y() - before.x[n].y()), 0), to = now.x[n] + rise + now.v[n] / k_fps;
    const double u = (to.x() - grid.origin.x()) / grid.cell, w = (to.z() - grid.origin.y()) / grid.cell;
    if (!(u > 1 && w > 1 && u < grid.nx - 1 && w < grid.nz - 1)) continue;
    // The plane through the vertices around: bilinear cells have creases.
    const auto height = [&](int i, int k) { return next.x[at(k) * (at(grid.nx) + 1) + at(i)].y(); };
    const int i = static_cast<int>(std::lround(u)), k = static_cast<int>(std::lround(w));
    const double there = height(i, k) + 0.5 * (u - i) * (height(i + 1, k) - height(i - 1, k)) +
                         0.5 * (w - k) * (height(i, k + 1) - height(i, k - 1));
    whole += std::pow(to.y() - there, 2);
    along += std::pow(to.y() - now.v[n].y() / k_fps - there, 2);
    stayed += std::pow(now.x[n].y() - next.x[n].y(), 2);
  }
  EXPECT_GT(stayed, 0);
  return {std::sqrt(whole / stayed), std::sqrt(along / stayed)};
}

double hill(double x, double z, double height) {
  return height * std::exp(-8 * (std::pow(x - 1.3, 2) + std::pow(z - 1.6, 2)));
}

ShallowSetup shallow_hill() {
  ShallowSetup s;
  s.nx = s.nz = 60, s.cell = 0.05, s.level = 0;
  s.manning = 0, s.viscosity = 0, s.splash.on = false;
  s.bed.assign(at(s.nx) * at(s.nz), -0.2);
  set_depth(s, [](double x, double z) { return 0.2 + hill(x, z, 0.15); });
  return s;
}

TEST(WaterSurface, Shallow_water_that_is_moved_by_its_velocities_is_that_of_the_next_frame) {
  WaterSolver solver = in_a_scene(shallow_core(shallow_hill()));
  State state = solver.initial_state();
  for (int f = 0; f < 150; ++f) solver.advance_frame(state);
  const Missed off = missed(solver, state);
  EXPECT_LT(off.whole, 0.05);
  EXPECT_GT(off.along, 3 * off.whole);
  // Outwards from where the hill was.
  const Surface now = surface_of(solver, state);
  double out = 0;
  for (std::size_t n = 0; n < now.x.size(); ++n)
    out += (now.x[n] - Vec3(1.3, 0, 1.6)).dot(Vec3(now.v[n].x(), 0, now.v[n].z()));
  EXPECT_GT(out, 0);
}

TEST(WaterSurface, The_papers_water_that_is_moved_by_its_velocities_is_that_of_the_next_frame) {
  PaperSetup s;
  s.nx = s.nz = 60, s.cell = 0.05, s.level = 0;
  s.bed.assign(at(s.nx) * at(s.nz), -0.2);
  set_depth(s, [](double x, double z) { return 0.2 + hill(x, z, 0.15); });
  s.splash.on = false;
  WaterSolver solver = in_a_scene(paper_core(std::move(s)));
  State state = solver.initial_state();
  for (int f = 0; f < 150; ++f) solver.advance_frame(state);
  const Missed off = missed(solver, state);
  EXPECT_LT(off.whole, 0.05);
  EXPECT_GT(off.along, 3 * off.whole);
}

TEST(WaterSurface, A_pond_that_is_moved_by_its_velocities_is_that_of_the_next_frame) {
  PondSetup s = square_pond(4, 64, 2);
  s.floats.push_back(floating_ball(0.3, 0.5, Vec3(1.7, 0.35, 2.2)));
  s.splash.on = false;
  WaterSolver solver = in_a_scene(pond_core(std::move(s)), 1);
  State state = solver.initial_state();
  for (int f = 0; f < 240; ++f) solver.advance_frame(state);
  const Missed off = missed(solver, state);
  EXPECT_LT(off.whole, 0.05);
  EXPECT_GT(off.along, 3 * off.whole);
}

TEST(WaterSurface, Ground_that_was_under_water_stays_marked_and_dries) {
  ShallowSetup s = shallow_hill();
  s.drying_time = 1;
  // Water stands in one half and runs over the other, which slopes back to it.
  set_bed(s, [](double x, double) { return x < 1.5 ? -0.2 : 0.2 * (x - 1.5) + 0.01; });
  set_depth(s, [](double x, double) { return x < 1.5 ? 0.25 : 0.0; });
  WaterSolver solver = in_a_scene(shallow_core(std::move(s)));
  ASSERT_EQ(std::vector<std::string>(solver.scalar_names(0).begin(), solver.scalar_names(0).end()),
            std::vector<std::string>{"wet"});
  EXPECT_TRUE(solver.scalar_names(1).empty()) << "droplets have none";
  State state = solver.initial_state();
  std::vector<std::vector<float>> start, later;
  solver.system_scalars(state, 0, start);
  for (int f = 0; f < 1440; ++f) solver.advance_frame(state);
  solver.system_scalars(state, 0, later);
  ASSERT_EQ(start.at(0).size(), solver.system_mesh(0).positions.size());
  int under = 0, marked = 0, never = 0;
  for (std::size_t n = 0; n < start[0].size(); ++n) {
    ASSERT_TRUE(later[0][n] >= 0 && later[0][n] <= 1);
    under += start[0][n] == 1, never += later[0][n] == 0;
    marked += start[0][n] == 0 && later[0][n] > 0.01 && later[0][n] < 0.999;
  }
  EXPECT_GT(under, 1000);
  EXPECT_GT(marked, 50);
  EXPECT_GT(never, 50);
  // Until water comes back it dries by the factor e in a drying time.
  constexpr int k_frames = 48;
  for (int f = 0; f < k_frames; ++f) solver.advance_frame(state);
  std::vector<std::vector<float>> after;
  solver.system_scalars(state, 0, after);
  int dried = 0;
  for (std::size_t n = 0; n < start[0].size(); ++n)
    dried += start[0][n] == 0 && later[0][n] > 0.01 &&
             std::abs(after[0][n] / later[0][n] - std::exp(-k_frames / k_fps)) < 1e-5;
  EXPECT_GT(dried, 50);
}

TEST(WaterSurface, Foam_is_where_droplets_have_landed_and_fades) {
  PondSetup s = square_pond(4, 64, 2);
  s.floats.push_back(floating_ball(0.3, 0.7, Vec3(2, 2, 2)));
  s.splash.foam_life = 0.5;
  WaterSolver solver = in_a_scene(pond_core(std::move(s)), 1, 48);
  ASSERT_EQ(solver.scalar_names(0).size(), 1u);
  EXPECT_EQ(solver.scalar_names(0)[0], "foam");
  State state = solver.initial_state();
  std::vector<std::vector<float>> now;
  std::vector<double> sums, distances;  // distances: of the foam from the ball, in the mean [m]
  for (int f = 0; f < 192; ++f) {
    solver.advance_frame(state);
    if (f % 24 != 23) continue;
    solver.system_scalars(state, 0, now);
    sums.push_back(0), distances.push_back(0);
    const auto& positions = solver.system_mesh(0).positions;
    for (std::size_t n = 0; n < positions.size(); ++n) {
      sums.back() += now.at(0)[n];
      distances.back() += now[0][n] * std::hypot(positions[n].x() - 2, positions[n].z() - 2);
    }
    distances.back() /= sums.back();
  }
  const auto most = std::ranges::max_element(sums);
  EXPECT_GT(*most, 1) << "of 4225 vertices";
  EXPECT_LT(sums.back(), 0.3 * *most);
  EXPECT_LT(distances[at(static_cast<int>(most - sums.begin()))], 1.25) << "m; 1.53 where it lies everywhere";
}

}  // namespace
}  // namespace ft::test
