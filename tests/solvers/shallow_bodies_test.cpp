// Bodies in shallow water, both ways, against their equations of motion.
#include <Eigen/Dense>
#include <numbers>

#include "baker/core/parallel.h"
#include "tests/solvers/shallow_scenes.h"

namespace ft {
namespace {

using namespace test;

/// A box of half length l across a channel that is one cell wide.
ShallowSetup strip(int cells_a_half, double half, double draft_share, double deep, double reach) {
  const double cell = half / cells_a_half;
  const int n = 2 * static_cast<int>(std::lround(reach / cell));
  ShallowSetup s = still_water(n, 1, cell, deep);
  s.origin = Vec2(-0.5 * n * cell, -0.5 * cell);
  ShallowFloat f = floating("box", box_surface(Vec3(2 * half, 0.5, cell)), 1000 * draft_share, Vec3::Zero());
  // So narrow it would fall over, if its length did not hold it.
  f.body.mass.inertia(0, 0) = f.body.mass.inertia(1, 1) = 1e6;
  s.floats.push_back(f);
  return s;
}

/// Largest error by the first displacement, of the heave of systems.md 9.5: half length .5, water 1 m, draft .25 m, 2
/// cm.
double heave_error(int cells, double& lowest) {
  const double l = 0.5, deep = 1, draft = 0.25, start = 0.02;
  ShallowSetup s = strip(cells, l, 0.5, deep, 2.5);
  s.floats[0].start.pose.position.y() = deep - draft + 0.25 + start;
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  // (m + 2 rho l^3 / 3 hw) y'' + (2 rho g l^2 / c) y' + 2 rho g l y = 0: water in the gap hw under the box is pushed
  // out to both sides, where it makes waves.
  const double rho = 1000, gap = deep - draft, c = std::sqrt(k_g * deep), m = rho * 2 * l * draft;
  const double mass = m + 2 * rho * l * l * l / (3 * gap), drag = 2 * rho * k_g * l * l / c, spring = 2 * rho * k_g * l;
  double y = start, v = 0, worst = 0;
  lowest = start;
  const double dt = 0.005;
  for (int n = 0; n < 200; ++n) {
    solver.advance_frame(state, dt);
    for (int k = 0; k < 100; ++k) {
      // Mid-point rule.
      const double h = dt / 100, a0 = -(drag * v + spring * y) / mass;
      const double vm = v + 0.5 * h * a0, ym = y + 0.5 * h * v;
      y += h * vm;
      v += h * -(drag * vm + spring * ym) / mass;
    }
    const double now = solver.floats(state)[0].pose.position.y() - (deep - draft + 0.25);
    worst = std::max(worst, std::abs(now - y));
    lowest = std::min(lowest, now);
  }
  return worst / start;
}

TEST(ShallowBodies, A_box_that_is_let_go_above_its_draft_heaves_as_its_equation_says) {
  double lowest = 0;
  const double coarse = heave_error(20, lowest);
  RecordProperty("percent_20", std::to_string(100 * coarse));
  RecordProperty("lowest_mm", std::to_string(1000 * lowest));
  EXPECT_LT(coarse, 0.01);
  EXPECT_NEAR(lowest, -4.75e-3, 0.15e-3);
}

TEST(ShallowBodies, Finer_cells_heave_more_exactly_slow) {
  double lowest = 0;
  const double fine = heave_error(40, lowest);
  RecordProperty("percent_40", std::to_string(100 * fine));
  EXPECT_LT(fine, 0.005);
}

/// Rotation of a box that is let go tilted, by its ODE, derived here. The box has half length l, draft D, gap hw under
/// it; th is its tilt (the right side down for th > 0 below: bottom at x sinks by th x), s = th'. Small tilts:
///
/// Water under it: the bottom sinks at x by s x, so q' = s x: q = q_c + s x^2 / 2, even in x. A wall at x = +l is D
/// high and turns, too: at the depth y below the box's middle line it moves by -s (y - y_axis) outwards... Its swept
/// volume is taken by the water outside: at x = l the flux into the outer water is q(l) + s a, where a is the first
/// moment of the wetted wall about the axis' height; outside waves rise by eta = +-(q_out) / c (right: going right).
struct Tilt {
  double l, draft, deep, mass_moment, stiffness;  ///< per metre of width; moment of inertia, m g GM
  double arm;                                     ///< axis above the middle of the wetted wall [m]

  // State: tilt, its rate, and the flux under the middle.
  Eigen::Vector3d rate(const Eigen::Vector3d& x) const {
    const double rho = 1000, hw = deep - draft, c = std::sqrt(k_g * deep);
    const double th = x[0], s = x[1], qc = x[2];
    // Reciprocity: the wall's volume per tilt is also its moment per head outside. A wall point at the height z above
    // the axis (z < 0 down the wall) goes outwards by s z when the right side sinks (turning clockwise seen from
    // -z...): the vector (l, z) turns so that (l, z) -> (l + s z dt, z - s l dt). Volume into the outer right water per
    // time: the integral of z over the wetted wall = D zm, zm the height of its middle above the axis = -arm.
    const double wall = -draft * arm;
    const double into_right = qc + 0.5 * s * l * l + s * wall;  // what raises the right water, going right
    const double eta = into_right / c;                          // head right; left it is -eta (q is even in x)
    // Under it: hw-momentum: q_t = -g hw zeta_x, integrated from -l to l with zeta(+-l) = +-eta:
    //   2 l qc' + s' l^3 / 3 = -g hw (2 eta)
    // Head: zeta_x = -(qc' + s' x^2/2) / (g hw), odd: zeta = -(qc' x + s' x^3/6) / (g hw).
    // Moment that turns the right side down (M on th): the pressure pushes the bottom up by rho g zeta at x, moment
    // -x rho g zeta: -rho g * 2 * int_0^l x zeta = 2 rho / hw (qc' l^3/3 + s' l^5/30).
    // Walls: outer head eta right presses the right wall inwards (-x direction) over the wetted height: virtual work
    // rho g eta times volume swept outwards: moment -rho g eta wall; the left wall alike (-eta, opposite sweep).
    // I s' = -K th + 2 rho/hw (qc' l^3/3 + s' l^5/30) - 2 rho g eta wall.
    Eigen::Matrix2d a;
    Eigen::Vector2d b;
    a << l * l * l / 3, 2 * l, mass_moment - 2 * rho / hw * std::pow(l, 5) / 30, -2 * rho / hw * l * l * l / 3;
    b << -2 * k_g * hw * eta, -stiffness * th - 2 * rho * k_g * eta * wall;
    const Eigen::Vector2d next = a.colPivHouseholderQr().solve(b);
    return {s, next[0], next[1]};
  }
};

double tilt_error(int cells, double degrees, double& zero_crossing) {
  const double l = 0.5, deep = 1, height = 0.5, density = 0.5;
  ShallowSetup s = strip(cells, l, density, deep, 3);
  const double draft = density * height, start = degrees * std::numbers::pi / 180;
  s.floats[0].start.pose.position.y() = deep - draft + 0.5 * height;
  s.floats[0].start.pose.rotation = Quat(Eigen::AngleAxisd(start, Vec3::UnitZ()));
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  const double rho = 1000, mass = rho * 2 * l * draft;
  Tilt ode;
  ode.l = l, ode.draft = draft, ode.deep = deep;
  ode.mass_moment = mass * (4 * l * l + height * height) / 12;
  // GM = BM - BG: BM = (2l)^3/12 / (2 l D); the middle of buoyancy is (height - draft)/2 below that of mass.
  ode.stiffness = mass * k_g * (l * l / (3 * draft) - 0.5 * (height - draft));
  ode.arm = 0.5 * height - 0.5 * draft;
  Eigen::Vector3d x(start, 0, 0);
  const double dt = 0.005;
  double worst = 0, before = start;
  zero_crossing = 0;
  for (int n = 0; n < 120; ++n) {
    solver.advance_frame(state, dt);
    for (int k = 0; k < 50; ++k) {
      const double h = dt / 50;
      const Eigen::Vector3d k1 = ode.rate(x), k2 = ode.rate(x + h * k1 / 2), k3 = ode.rate(x + h * k2 / 2),
                            k4 = ode.rate(x + h * k3);
      x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    const Quat q = solver.floats(state)[0].pose.rotation;
    const double now = 2 * std::atan2(q.z(), q.w());
    if (before > 0 && now <= 0) zero_crossing = dt * (n + before / (before - now));
    before = now;
    worst = std::max(worst, std::abs(now - x[0]));
  }
  return worst / start;
}

TEST(ShallowBodies, A_box_that_is_let_go_tilted_rolls_as_its_equation_says) {
  double zero = 0;
  const double error = tilt_error(20, 10, zero);
  RecordProperty("percent_20", std::to_string(100 * error));
  RecordProperty("zero_s", std::to_string(zero));
  EXPECT_LT(error, 0.08);
}

TEST(ShallowBodies, Balls_rest_at_their_drafts) {
  for (const double density : {200.0, 500.0, 800.0}) {
    ShallowSetup s = still_water(24, 24, 0.05, 0.6);
    const double r = 0.2, middle = 0.6;
    // Height of the middle above the water where the cap that is under has the ball's mass, by halving; of the mesh, as
    // hydrostatics() has it.
    const TriangleSurface ball = sphere_surface(r, 3);
    double lo = -r, hi = r;
    const ShallowFloat at_rest = floating("ball", ball, density, Vec3::Zero());
    for (int n = 0; n < 60; ++n) {
      const double y = 0.5 * (lo + hi);
      (hydrostatics(ball.positions, ball.triangles, -y, 1, Vec3::Zero()).volume * 1000 > at_rest.body.mass.mass ? lo
                                                                                                                : hi) =
          y;
    }
    s.floats.push_back(floating("ball", ball, density, Vec3(middle, 0.6 + lo, middle), 0.47));
    ShallowSolver solver = solver_of(s);
    State state = solver.initial_state();
    for (int f = 0; f < 24; ++f) {
      const ShallowReport r2 = solver.advance_frame(state, 1.0 / 24);
      EXPECT_EQ(r2.failed_solves, 0);
    }
    EXPECT_NEAR(solver.floats(state)[0].pose.position.y() - 0.6, lo, 1e-6) << density;
    EXPECT_LT(solver.floats(state)[0].velocity.norm(), 1e-5);
  }
}

TEST(ShallowBodies, A_ball_of_half_the_density_settles_at_its_middle) {
  ShallowSetup s = still_water(24, 24, 0.05, 0.6);
  s.edges.fill(ShallowEdge::k_open);
  s.floats.push_back(floating("ball", sphere_surface(0.2, 3), 500, Vec3(0.6, 0.65, 0.6), 0.47));
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  for (int f = 0; f < 24 * 6; ++f) solver.advance_frame(state, 1.0 / 24);
  const auto h = solver.depths(state);
  EXPECT_NEAR(solver.floats(state)[0].pose.position.y(), h[0], 2e-4);
}

TEST(ShallowBodies, A_ball_of_density_two_sinks_at_its_terminal_speed) {
  const double r = 0.05, drag = 0.47, expected = std::sqrt(8 * r * k_g / (3 * drag));
  ShallowSetup s = still_water(40, 40, 0.02, 2.5);
  const TriangleSurface ball = sphere_surface(r, 3);
  s.floats.push_back(floating("ball", ball, 2000, Vec3(0.4, 2.35, 0.4), drag));
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  double speed = 0;
  for (int f = 0; f < 40; ++f) {
    solver.advance_frame(state, 1.0 / 24);
    const RigidMotion m = solver.floats(state)[0];
    if (m.pose.position.y() > 0.3) speed = -m.velocity.y();
  }
  RecordProperty("speed", std::to_string(speed));
  EXPECT_NEAR(expected, 1.67, 0.01);
  EXPECT_NEAR(speed, expected, 0.02 * expected);
  // And lies on the ground in the end.
  for (int f = 0; f < 40; ++f) solver.advance_frame(state, 1.0 / 24);
  EXPECT_NEAR(solver.floats(state)[0].pose.position.y(), r, 2e-3);
  EXPECT_LT(solver.floats(state)[0].velocity.norm(), 0.02);
}

TEST(ShallowBodies, Energy_of_a_rolling_box_in_a_basin_never_rises_by_more_than_a_twentieth) {
  const double l = 0.5, deep = 1;
  ShallowSetup s = strip(20, l, 0.5, deep, 1.5);
  s.floats[0].start.pose.position.y() = deep;
  const auto energy_at_rest = [&] {
    ShallowSolver solver = solver_of(s);
    State state = solver.initial_state();
    const ShallowReport r = solver.advance_frame(state, 1e-4);
    return r.kinetic + r.potential + r.floats_energy;
  }();
  s.floats[0].start.pose.rotation = Quat(Eigen::AngleAxisd(10 * std::numbers::pi / 180, Vec3::UnitZ()));
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  double first = 0, lowest = 0, rise = 0;
  const double volume = solver.ledger(state).total();
  for (int f = 0; f < 150; ++f) {
    const ShallowReport r = solver.advance_frame(state, 0.02);
    const double energy = r.kinetic + r.potential + r.floats_energy - energy_at_rest;
    if (f == 0) first = lowest = energy;
    lowest = std::min(lowest, energy);
    rise = std::max(rise, energy - lowest);
  }
  RecordProperty("rise_percent", std::to_string(100 * rise / first));
  EXPECT_GT(first, 0);
  EXPECT_LT(rise, 0.05 * first);
  EXPECT_NEAR(solver.ledger(state).total(), volume, 1e-12 * volume);
}

TEST(ShallowBodies, A_ball_that_falls_in_dives_and_floats_and_the_water_is_all_there) {
  ShallowSetup s = still_water(40, 40, 0.05, 0.8);
  s.splash.on = true;
  s.floats.push_back(floating("ball", sphere_surface(0.2, 2), 500, Vec3(1, 1.5, 1), 0.47));
  ShallowSolver solver = solver_of(s);
  State state = solver.initial_state();
  const double volume = solver.ledger(state).total();
  double deepest = 2;
  int failed = 0;
  for (int f = 0; f < 24 * 4; ++f) {
    const ShallowReport r = solver.advance_frame(state, 1.0 / 24);
    failed += r.failed_solves;
    EXPECT_EQ(r.lowest_depth, 0);
    deepest = std::min(deepest, solver.floats(state)[0].pose.position.y());
  }
  EXPECT_LT(deepest, 0.75);
  EXPECT_NEAR(solver.floats(state)[0].pose.position.y(), 0.8, 0.03);
  EXPECT_EQ(failed, 0);
  EXPECT_NEAR(solver.ledger(state).total(), volume, 1e-12 * volume);
}

TEST(ShallowBodies, Setups_that_cannot_be_are_refused_with_their_numbers) {
  const auto refused = [](const ShallowSetup& s, const std::string& part) {
    const auto made = ShallowSolver::make(s);
    EXPECT_FALSE(made.ok()) << part;
    const std::string text = made.ok() ? "" : made.error().text();
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  ShallowSetup s = still_water(10, 10, 0.1, 0.2);
  EXPECT_TRUE(ShallowSolver::make(s).ok());
  ShallowSetup dry = s;
  dry.bed.assign(100, 0.3);
  refused(dry, "0.3 m at its lowest");
  ShallowSetup large = s;
  large.floats.push_back(floating("raft", box_surface(Vec3(1.5, 0.1, 0.3)), 500, Vec3(0.5, 0.2, 0.5)));
  refused(large, "\"raft\" is 1.5 x 0.3 m, larger than the domain of 1 x 1 m");
  ShallowSetup two = s;
  two.floats.push_back(floating("a", sphere_surface(0.1, 2), 500, Vec3(0.4, 0.2, 0.5)));
  two.floats.push_back(floating("b", sphere_surface(0.1, 2), 500, Vec3(0.61, 0.2, 0.5)));
  EXPECT_TRUE(ShallowSolver::make(two).ok());
  two.floats[1].start.pose.position.x() = 0.58;
  refused(two, "\"a\" and \"b\" overlap at the start");
  ShallowSetup much = s;
  much.nx = much.nz = 20000;
  refused(much, "MB allowed");
}

}  // namespace
}  // namespace ft
