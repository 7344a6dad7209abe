// Leaves in the air: terminal speed, tracers, storms, how they come down, the same bytes however they are computed.
#include "baker/core/parallel.h"
#include "tests/solvers/leaf_scenes.h"

namespace ft {
namespace {

using namespace test;

TEST(Leaves, A_leaf_that_is_kept_face_on_falls_at_its_terminal_speed) {
  LeavesSetup setup = many_leaves(1, 0, 1, 0);
  setup.prototypes[0] = almond_leaf("flat", 0.08, 0.05, 0);
  setup.leaves[0].orientation = Quat::Identity();
  setup.mass_variation = 0;
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  // Level exactly, it stays so: nothing turns it.
  for (int f = 0; f < 48; ++f) solver->advance_frame(state);
  const double expected = std::sqrt(2 * 0.08 * k_gravity / (1.225 * 1.2));
  EXPECT_NEAR(expected, 1.03, 0.005);
  EXPECT_NEAR(-leaves_of(*solver, state)[0].velocity.y(), expected, 0.01 * expected);
}

TEST(Leaves, A_light_leaf_circles_in_a_vortex_with_the_period_of_the_air) {
  // In the core all circles take as long, 4 pi^2 R^2 / circulation; outside 4 pi^2 r^2 / circulation.
  for (const double radius : {0.5, 1.5}) {
    LeavesSetup setup = many_leaves(1, 1, 1, 0, 1e-7);
    setup.gravity.setZero();
    setup.mass_variation = 0;
    setup.leaves[0].position = Vec3(radius, 1, 0);
    const double circulation = 6, core = 1;
    setup.wind = rankine(circulation, core);
    const auto solver = solver_of(setup);
    State state = solver->initial_state();
    const double larger = std::max(radius, core);
    const double period = 4 * std::numbers::pi * std::numbers::pi * larger * larger / circulation;
    double angle = 0, before = 0, spent = 0;
    Vec3 place;
    for (int f = 0; f < 24 * 60 && angle < 2 * std::numbers::pi; ++f) {
      solver->advance_frame(state);
      place = leaves_of(*solver, state)[0].position;
      const double now = std::atan2(-place.z(), place.x());
      double turn = now - before;
      if (turn < -std::numbers::pi) turn += 2 * std::numbers::pi;
      if (turn > std::numbers::pi) turn -= 2 * std::numbers::pi;
      before = now;
      angle += std::abs(turn);
      spent = state.time;
    }
    const double measured = spent * 2 * std::numbers::pi / angle;
    printf("radius %.1f: period %.3f s, expected %.3f; radius after a turn %.3f\n", radius, measured, period,
           Vec3(place.x(), 0, place.z()).norm());
    EXPECT_NEAR(measured, period, 0.01 * period);
  }
}

TEST(Leaves, Any_leaf_in_any_wind_stays_finite_and_is_no_faster_than_the_air) {
  for (const double area_mass : {0.08, 0.24e-3 / 0.00249, 0.01e-3 / 0.00249})
    for (const double speed : {5.0, 30.0, 100.0})
      for (const bool gusts : {false, true}) {
        LeavesSetup setup = many_leaves(30, 5, 0.3, 0.5, area_mass);
        // Gusts: the wind drops to a half and comes back at once, several times a second.
        setup.wind = wind_of(
            [=](const Vec3&, double t) {
              const double now = gusts && std::fmod(t, 0.3) > 0.15 ? 0.5 * speed : 0.97 * speed;
              return Vec3(now, gusts ? 0.2 * speed * std::sin(40 * t) : 0, 0);
            },
            speed);
        const auto solver = solver_of(setup);
        State state = solver->initial_state();
        const double terminal = std::sqrt(2 * 1.2 * area_mass * k_gravity / (1.225 * 0.2));  // edge on
        double fastest = 0;
        for (int f = 0; f < 36; ++f) {
          const FrameReport report = solver->advance_frame(state);
          ASSERT_TRUE(report.finite);
          fastest = std::max(fastest, report.own.at("leaves_fastest"));
          for (const LeafState& l : leaves_of(*solver, state)) {
            ASSERT_TRUE(l.position.allFinite() && l.velocity.allFinite() && l.angular_velocity.allFinite());
            ASSERT_NEAR(l.orientation.norm(), 1, 1e-9);
          }
        }
        // Through the air a leaf gains no energy from the air. Steady: no faster than it. A gust that jumps by J makes
        // it glide at J through the air, in any direction.
        const double jump = gusts ? 0.47 * speed + 0.4 * speed : 0.0;
        EXPECT_LT(fastest, (gusts ? 1.0 : 1.2) * speed + jump + terminal) << area_mass << " " << speed << " " << gusts;
      }
}

TEST(Leaves, Leaves_glide_and_tumble_and_do_not_come_down_like_parachutes) {
  LeavesSetup setup = many_leaves(200, 3, 0, 0.15);
  setup.grounds.push_back({});
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  double awake = 200;
  for (int f = 0; f < 24 * 20 && awake > 0; ++f) awake = solver->advance_frame(state).own.at("leaves_awake");
  double sum = 0, squares = 0;
  for (const LeafState& l : leaves_of(*solver, state)) {
    const double away = std::hypot(l.position.x(), l.position.z());
    sum += away, squares += away * away;
  }
  printf("landed %.2f m from below where they started, root mean square %.2f m; %d frames\n", sum / 200,
         std::sqrt(squares / 200), state.frame);
  EXPECT_EQ(awake, 0);
  EXPECT_GT(sum / 200, 0.5);
  EXPECT_LT(sum / 200, 3.0);
}

LeavesSetup busy_scene() {
  LeavesSetup setup = many_leaves(150, 0.6, 0.08, 0.4);
  setup.grounds.push_back({});
  setup.bodies.push_back(obstacle_of("capsule", capsule_surface(0.12, 0.5, 2), Vec3(0, 0.4, 0),
                                     [](double t) { return Vec3(0.5 * std::sin(5 * t), 0, 0); }));
  setup.wind = wind_of(
      [](const Vec3& p, double t) { return Vec3(3 * std::sin(2 * p.z() + 3 * t), 0.3, 2 * std::cos(p.x())); }, 4);
  return setup;
}

TEST(Leaves, One_thread_and_two_and_a_restored_state_have_the_same_bytes) {
  std::vector<Hash128> one, two;
  Bytes saved;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    const auto solver = solver_of(busy_scene());
    State state = solver->initial_state();
    for (int f = 0; f < 30; ++f) {
      solver->advance_frame(state);
      (threads == 1 ? one : two).push_back(hash(state));
      if (threads == 1 && f == 14) saved = save(state);
    }
  }
  EXPECT_TRUE(one == two);
  const auto solver = solver_of(busy_scene());
  auto state = load_state(saved);
  ASSERT_TRUE(state);
  for (std::size_t f = 15; f < 30; ++f) {
    solver->advance_frame(*state);
    ASSERT_TRUE(hash(*state) == one[f]) << f;
  }
}

TEST(Leaves, Cost_of_many_leaves_in_wind_slow) {
  const ThreadLimit limit(1);
  double of_5000 = 0;
  for (const int count : {5000, 50000}) {
    LeavesSetup setup = many_leaves(count, 50, 0.1, 0.5);
    setup.wind = wind_of([](const Vec3& p, double t) { return Vec3(4 + std::sin(p.x() + t), 0, std::cos(p.z())); }, 6);
    const auto solver = solver_of(setup);
    State state = solver->initial_state();
    std::vector<double> ms;
    double steps = 0;
    for (int f = 0; f < 11; ++f) {
      const FrameReport report = solver->advance_frame(state);
      steps = report.own.at("leaf_steps");
      ms.push_back(1e3 * report.profile.total);
    }
    std::nth_element(ms.begin(), ms.begin() + 5, ms.end());
    printf("%d awake: %.1f ms a frame, %.1f steps a leaf\n", count, ms[5], steps / count);
    if (count == 5000)
      of_5000 = ms[5];
    else
      EXPECT_LT(ms[5], 14 * of_5000);  // 12, and what a busy machine adds
  }
}

}  // namespace
}  // namespace ft
