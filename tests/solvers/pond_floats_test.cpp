// Floating bodies of the pond against linear theory (Cummins with Hulme's hemisphere), other codes' decay of a sphere
// (IEA OES task 10), Archimedes, and their own energy.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "tests/solvers/pond_scenes.h"

namespace ft {
namespace {

Swing heave(const PondSolver& pond, double seconds, double frame_time, double scale, double rest = 0) {
  State state = pond.initial_state();
  Swing out;
  out.add(0, (pond.float_motions(state)[0].pose.position.y() - rest) / scale);
  while (state.time < seconds) {
    pond.advance_frame(state, frame_time, {});
    out.add(state.time, (pond.float_motions(state)[0].pose.position.y() - rest) / scale);
  }
  return out;
}

void show(const Swing& s) {
  if (std::getenv("POND_SHOW") == nullptr) return;
  for (const double z : s.zeros) std::printf("zero %.4f  ", z);
  for (const double z : s.extremes) std::printf("extreme %.4f  ", z);
  std::printf("\n");
}

// Six codes: trough -0.87 to -0.89, peak 0.63 to 0.65, period 4.37 to 4.45 s.
TEST(PondFloats, The_sphere_of_many_codes_sinks_back_as_with_them) {
  PondSetup s = square_pond(100, 160, 60);
  s.floats.push_back(floating_ball(5, 261800 / (1000 * 4.0 / 3 * std::numbers::pi * 125), Vec3(50, 1, 50)));
  const Swing swing = heave(*made(s), 8, 1.0 / 24, 1);
  show(swing);
  ASSERT_GE(swing.zeros.size(), 3u);
  EXPECT_NEAR(swing.extremes[0], -0.88, 0.03);
  EXPECT_NEAR(swing.extremes[1], 0.64, 0.03);
  EXPECT_NEAR(swing.extreme_times[1], 4.40, 0.09);
}

// Zeros and extremes of the Cummins equation for a ball of 0.15 m in deep water.
TEST(PondFloats, A_ball_heaves_as_linear_theory_says) {
  PondSetup s = square_pond(4, 128, 2);
  s.floats.push_back(floating_ball(0.15, 0.5, Vec3(2, 0.15 / 20, 2)));
  const Swing swing = heave(*made(s), 1.45, 1.0 / 120, 0.15 / 20);
  show(swing);
  const double zeros[] = {0.197, 0.587, 0.966, 1.342}, extremes[] = {-0.867, 0.635, -0.465};
  ASSERT_GE(swing.zeros.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(swing.zeros[i], zeros[i], 0.02 * zeros[i]);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(swing.extremes[i], extremes[i], 0.1 * std::abs(extremes[i]));
  EXPECT_NEAR(swing.zeros[3] - swing.zeros[1], 1.342 - 0.587, 0.02 * 0.755);
}

/// Heave over the wave's height, of a ball at the antinode of a standing wave: fitted after its own swing has died.
double heave_response(double ka) {
  const double radius = 0.15, k = ka / radius, length = 2 * std::numbers::pi / k;
  // Whole wavelengths across: antinodes at the walls and the middle.
  PondSetup s = square_pond(std::ceil(4 / length) * length, 0, 3);
  s.nx = s.nz = 2 * static_cast<int>(std::clamp(s.size_x / radius * 2.5, 32.0, 96.0));
  s.floats.push_back(floating_ball(radius, 0.5, Vec3(0.5 * s.size_x, 0, 0.5 * s.size_z)));
  s.floats[0].body.drag = 0;
  s.edges = PondEdge::k_wall;
  const auto pond = made(s);
  State state = pond->initial_state();
  const std::size_t wave = at(static_cast<int>(std::lround(s.size_x * k / std::numbers::pi)));
  EXPECT_NEAR(pond->modes().kx[wave], k, 1e-9 * k);
  const double amplitude = 0.01 * radius;
  const double sign = wave % 2 == 0 && wave % 4 != 0 ? -1 : 1;
  state.block("eta")[wave] = sign * amplitude;
  const double omega = std::sqrt(9.81 * k * std::tanh(k * s.depth));
  // Least squares of z = a cos wt + b sin wt over whole periods, after the ball's own swing.
  const double from = 3.5, to = from + 2 * 2 * std::numbers::pi / omega, dt = 1.0 / 60;
  double cc = 0, ss = 0, cs = 0, zc = 0, zs = 0;
  while (state.time < to) {
    pond->advance_frame(state, dt, {});
    if (state.time < from) continue;
    const double z = pond->float_motions(state)[0].pose.position.y(), c = std::cos(omega * state.time),
                 n = std::sin(omega * state.time);
    cc += c * c, ss += n * n, cs += c * n, zc += z * c, zs += z * n;
  }
  const double det = cc * ss - cs * cs;
  const auto size = [&](double p, double q) { return std::hypot((p * ss - q * cs) / det, (q * cc - p * cs) / det); };
  return size(zc, zs) / amplitude;
}

TEST(PondFloats, A_ball_answers_waves_of_all_lengths_as_theory_says_slow) {
  const std::pair<double, double> table[] = {{0.1, 1.00}, {0.2, 1.01}, {0.4, 1.06}, {0.6, 1.18},
                                             {0.8, 1.48}, {1, 1.88},   {1.3, 0.93}};
  for (const auto& [ka, theory] : table) {
    const double got = heave_response(ka);
    if (std::getenv("POND_SHOW")) std::printf("ka %.1f: %.3f of %.2f\n", ka, got, theory);
    EXPECT_NEAR(got, theory, 0.06 * theory) << "ka " << ka;
  }
}

/// Of a body let go 4 mm too high, after a minute in open water.
RigidMotion settled(PondFloat body) {
  PondSetup s = square_pond(6, 48, 2);
  s.edges = PondEdge::k_open;
  s.rim = 2;
  body.start.pose.position += Vec3(3, 0.004, 3);
  s.floats.push_back(std::move(body));
  const auto pond = made(s);
  State state = pond->initial_state();
  for (int f = 0; f < 720; ++f) pond->advance_frame(state, 1.0 / 12, {});
  return pond->float_motions(state)[0];
}

TEST(PondFloats, Balls_and_boxes_come_to_rest_where_Archimedes_says) {
  for (const double density : {0.2, 0.5, 0.8}) {
    // Volume of a cap: pi t^2 (R - t / 3) = density 4/3 pi R^3.
    const double radius = 0.15;
    double lo = 0, hi = 2 * radius;
    for (int i = 0; i < 100; ++i) {
      const double t = 0.5 * (lo + hi);
      (t * t * (radius - t / 3) < density * 4.0 / 3 * radius * radius * radius ? lo : hi) = t;
    }
    const RigidMotion ball = settled(floating_ball(radius, density, Vec3(0, radius - lo, 0)));
    EXPECT_NEAR(ball.pose.position.y(), radius - lo, 1e-6) << density;
    const double height = 0.2 * (0.5 - density);
    const RigidMotion box = settled(floating_box(Vec3(0.6, 0.2, 0.4), density, Vec3(0, height, 0)));
    EXPECT_NEAR(box.pose.position.y(), height, 1e-6) << density;
    EXPECT_LT((box.pose.rotation * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-6) << density;
  }
}

TEST(PondFloats, A_ball_of_density_two_sinks_at_its_terminal_speed) {
  PondSetup s = square_pond(8, 64, 30);
  const double radius = 0.15;
  s.floats.push_back(floating_ball(radius, 2, Vec3(4, -0.5, 4)));
  const auto pond = made(s);
  State state = pond->initial_state();
  for (int f = 0; f < 96; ++f) pond->advance_frame(state, 1.0 / 24, {});
  const double terminal = std::sqrt(8 * radius * 9.81 / (3 * 0.47));
  EXPECT_NEAR(-pond->float_motions(state)[0].velocity.y(), terminal, 0.02 * terminal);
}

TEST(PondFloats, Three_balls_dropped_gain_no_energy) {
  PondSetup s = square_pond(6, 128, 2);
  const double densities[] = {0.2, 0.5, 0.8};
  double drop = 0;
  for (int i = 0; i < 3; ++i) {
    s.floats.push_back(floating_ball(0.15, densities[i], Vec3(1.8 + 1.1 * i, 0.65, 3), "ball" + std::to_string(i)));
    drop += s.floats.back().body.mass.mass * 9.81 * 0.5;
  }
  s.splash.on = false;
  const auto pond = made(s);
  State state = pond->initial_state();
  double least = pond->energy(state).total(), rise = 0;
  PondEnergy e;
  for (int f = 0; f < 120; ++f) {
    e = pond->advance_frame(state, 1.0 / 48, {}).energy;
    rise = std::max(rise, e.total() - least);
    least = std::min(least, e.total());
  }
  if (std::getenv("POND_SHOW")) std::printf("rise %.4g of %.4g J; slam %.3g drag %.3g\n", rise, drop, e.slam, e.drag);
  EXPECT_LT(rise, 1e-3 * drop);
  EXPECT_GT(e.slam, 0);
}

/// Period of a box that is let go tilted about an axis, [s]; and how much it keeps of its angle in one.
std::pair<double, double> rocking(const Vec3& size, const Vec3& axis, double angle) {
  PondSetup s = square_pond(10, 96, 3);
  s.edges = PondEdge::k_open;
  s.floats.push_back(floating_box(size, 0.5, Vec3(5, 0, 5)));
  s.floats[0].body.drag = 0;
  s.floats[0].start.pose.rotation = Quat(Eigen::AngleAxisd(angle, axis));
  const auto pond = made(s);
  State state = pond->initial_state();
  Swing swing;
  while (state.time < 6) {
    pond->advance_frame(state, 1.0 / 48, {});
    const Quat q = pond->float_motions(state)[0].pose.rotation;
    swing.add(state.time, 2 * q.vec().dot(axis) / angle);
  }
  show(swing);
  return {swing.zeros[2] - swing.zeros[0], swing.extremes.size() > 1 ? swing.extremes[1] : 0};
}

// 2 pi sqrt((I + I_a) / K): K = rho g (I_waterplane - V (KG - KB)), I_a by strips of the ellipsoid's added mass, which
// is what the model says it has at once; radiation adds to the mass and takes from the swing.
TEST(PondFloats, A_box_rocks_at_the_period_of_its_waterplane_and_inertia) {
  const Vec3 size(1.2, 0.3, 0.6);
  for (const auto& [axis, along, across] : {std::tuple{Vec3(0, 0, 1), 1.2, 0.6}, {Vec3(1, 0, 0), 0.6, 1.2}}) {
    PondSetup s = square_pond(10, 32, 3);
    s.floats.push_back(floating_box(size, 0.5, Vec3(5, 0, 5)));
    const double added = made(s)->float_shape_of(0).added.y();
    const double volume = 0.5 * size.prod(), mass = 1000 * volume;
    const double stiffness = 1000 * 9.81 * (across * along * along * along / 12 - volume * 0.075);
    const double inertia = mass * (along * along + 0.09) / 12 + added * mass * along * along / 12;
    const double theory = 2 * std::numbers::pi * std::sqrt(inertia / stiffness);
    const auto [period, kept] = rocking(size, axis, 0.05);
    if (std::getenv("POND_SHOW"))
      std::printf("period %.3f of %.3f s, keeps %.3f; added %.3f\n", period, theory, kept, added);
    EXPECT_NEAR(period, theory, 0.1 * theory);
    EXPECT_GT(kept, 0.1);
    EXPECT_LT(kept, 0.99) << "waves take of its swing";
  }
}

TEST(PondFloats, A_boat_that_turns_over_comes_to_rest_and_keeps_to_Archimedes) {
  PondSetup s = square_pond(6, 64, 2);
  s.edges = PondEdge::k_open;
  s.floats.push_back(floating_box(Vec3(0.9, 0.25, 0.45), 0.4, Vec3(3, 0.3, 3)));
  s.floats[0].start.pose.rotation = Quat(Eigen::AngleAxisd(1.9, Vec3(1, 0.2, 0.3).normalized()));
  const auto pond = made(s);
  State state = pond->initial_state();
  double least = pond->energy(state).total(), rise = 0;
  const double start = least;
  for (int f = 0; f < 480; ++f) {
    const double e = pond->advance_frame(state, 1.0 / 24, {}).energy.total();
    rise = std::max(rise, e - least), least = std::min(least, e);
  }
  const RigidMotion now = pond->float_motions(state)[0];
  EXPECT_NEAR(std::abs((now.pose.rotation * Vec3::UnitY()).y()), 1, 1e-3);
  EXPECT_NEAR(now.pose.position.y(), 0.25 * 0.1, 1e-3);
  if (std::getenv("POND_SHOW")) std::printf("rise %.3g of %.3g\n", rise, start - least);
  EXPECT_LT(rise, 0.02 * (start - least));
}

TEST(PondFloats, Bodies_meet_and_stay_in_the_pool) {
  PondSetup s = square_pond(2, 32, 1);
  s.floats.push_back(floating_ball(0.15, 0.5, Vec3(0.5, 0, 1), "a"));
  s.floats.push_back(floating_ball(0.15, 0.5, Vec3(1.2, 0, 1.02), "b"));
  s.floats.push_back(floating_ball(0.1, 3, Vec3(1.6, 0.3, 0.5), "stone"));
  s.floats[0].start.velocity = Vec3(3, 0, 0);
  const auto pond = made(s);
  State state = pond->initial_state();
  bool hit = false;
  for (int f = 0; f < 96; ++f) {
    pond->advance_frame(state, 1.0 / 24, {});
    const auto now = pond->float_motions(state);
    EXPECT_GT((now[0].pose.position - now[1].pose.position).norm(), 0.3 - 0.01);
    hit = hit || now[1].velocity.x() > 0.3;
    for (const RigidMotion& m : now) {
      EXPECT_GT(m.pose.position.x(), 0.09);
      EXPECT_LT(m.pose.position.x(), 1.91);
      EXPECT_GT(m.pose.position.y(), -0.901);
    }
  }
  EXPECT_TRUE(hit);
  EXPECT_NEAR(pond->float_motions(state)[2].pose.position.y(), -0.9, 1e-3);
}

}  // namespace
}  // namespace ft
